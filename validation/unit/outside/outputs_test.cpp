// Outputs replace nothing that a command reads and no other output, and have no name of another format. The options are
// those of the program's own tables, so that a new one is tried at once.
#include "cli/commands.h"
#include "support/test.h"

namespace exactff {
namespace {

namespace fs = std::filesystem;
using cli::CommandTable;
using cli::Completion;
using cli::OptionRow;
using flags::Beside;
using flags::FileMark;
using Use = FileMark::Use;

std::vector<CommandTable> command_tables() {
  CLI::App app("", "exactff");
  (void)cli::add_commands(app);
  return cli::program_table(app).commands;
}

std::vector<const OptionRow*> rows_of(const CommandTable& command) {
  std::vector<const OptionRow*> rows;
  for (const OptionRow& row : command.positionals) rows.push_back(&row);
  for (const OptionRow& row : command.options) rows.push_back(&row);
  return rows;
}

bool is_positional(const OptionRow& row) { return !row.names.front().starts_with('-'); }
bool is_written(const OptionRow& row) { return row.file && row.file->use != Use::kRead; }
bool is_read(const OptionRow& row) { return row.file && row.file->use == Use::kRead; }

std::string extension_of(const OptionRow& row) {
  const auto extensions = flags::extensions_of(row.file->format);
  return extensions.empty() ? ".txt" : std::string(extensions.front());
}

const OptionRow* row_named(const CommandTable& command, const std::string& name) {
  for (const OptionRow* row : rows_of(command)) {
    if (std::ranges::find(row->names, name) != row->names.end()) return row;
  }
  return nullptr;
}

// By what name an output leads to a file that is read.
enum class Name { kSame, kOtherSpelling, kSymbolicLink, kHardLink };

class Outputs : public testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return (directory_.path() / name).string(); }

  // Returns the exit code; standard error is in error_.
  int run(const Words& words) {
    const RunningProgram running(EXACTFF_PROGRAM, words, path("stderr"));
    const int code = running.wait();
    error_ = running.error();
    return code;
  }

  // A command line with these values, and others for what else is required. It is complete enough to be parsed.
  [[nodiscard]] Words line(const CommandTable& command, const std::map<const OptionRow*, std::string>& values) const {
    Words words = {command.name};
    for (const OptionRow* row : rows_of(command)) {
      const auto value = values.find(row);
      if (value == values.end() && !row->required) continue;
      if (!is_positional(*row)) words.push_back(row->names.front());
      if (value != values.end()) {
        words.push_back(value->second);
      } else if (row->file) {
        words.push_back(path(row->names.front() + ".other" + extension_of(*row)));
      } else {
        words.insert(words.end(), static_cast<std::size_t>(row->least_values), "1");
      }
    }
    return words;
  }
  // With --force, if the command has it and this output does.
  [[nodiscard]] static Words forced(const CommandTable& command, const OptionRow& output, Words words) {
    const OptionRow* force = row_named(command, "--force");
    if (force == nullptr) return {};
    const std::size_t only = force->description.find("(only with ");
    if (only != std::string::npos && force->description.find(output.names.back(), only) == std::string::npos) return {};
    words.emplace_back("--force");
    return words;
  }

  // A name of the file: the one to be given for the output.
  [[nodiscard]] std::string alias(const std::string& file, Name name) const {
    const std::string link = path("link" + fs::path(file).extension().string());
    fs::remove(link);
    if (name == Name::kOtherSpelling) return (fs::path(file).parent_path() / "." / fs::path(file).filename()).string();
    if (name == Name::kSymbolicLink) fs::create_symlink(file, link);
    if (name == Name::kHardLink) fs::create_hard_link(file, link);
    return name == Name::kSame ? file : link;
  }

  void expect_refused(const Words& words, const Words& told) {
    if (words.empty()) return;
    ++runs_;
    EXPECT_EQ(run(words), 2) << testing::PrintToString(words);
    for (const std::string& word : told) {
      EXPECT_HOLDS(error_, word) << word << "\n" << testing::PrintToString(words) << '\n' << error_;
    }
  }
  // With and without --force.
  void expect_kept(const CommandTable& command, const OptionRow& output, const Words& words, const std::string& file,
                   const Words& told) {
    const std::string bytes = text_of(file);
    expect_refused(words, told);
    expect_refused(forced(command, output, words), told);
    EXPECT_EQ(text_of(file), bytes) << testing::PrintToString(words);
  }

  static constexpr const char* kScene =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 1 1\nv 1 0 1\ng floor\nf 1 2 3\ng lid\nf 4 5 6\n";
  const TemporaryDirectory directory_{memory_folder()};
  std::string error_;
  int runs_ = 0;
};

TEST_F(Outputs, AreMarkedAsFilesThatAreWrittenAndInputsAsFilesThatAreRead) {
  const std::set<std::string> are_text = {"matrix --zone", "compare --title"};
  for (const CommandTable& command : command_tables()) {
    for (const OptionRow* row : rows_of(command)) {
      const bool may_be_file = row->completion == Completion::kFiles || row->completion == Completion::kFolders ||
                               row->completion == Completion::kFilesAndModels ||
                               row->value.find("FILE") != std::string::npos;
      const std::string name = command.name + ' ' + row->names.back();
      EXPECT_EQ(row->file.has_value(), may_be_file && !are_text.contains(name))
          << name << ": mark it by flags::is_read() or flags::is_written()";
    }
  }
}

TEST_F(Outputs, ReplaceNothingThatIsReadWhateverFlagsSay) {
  int turn = 0;
  for (const CommandTable& command : command_tables()) {
    for (const OptionRow* input : rows_of(command)) {
      for (const OptionRow* output : rows_of(command)) {
        if (!is_read(*input) || !is_written(*output)) continue;
        const bool folder = output->file->use == Use::kFolder;
        fs::create_directory(path("folder"));
        const std::string file = path((folder ? "folder/in" : "in") + extension_of(*output));
        write_text(file, "precious");
        const std::string name = folder ? path("folder") : alias(file, static_cast<Name>(turn++ % 4));
        expect_kept(command, *output, line(command, {{input, file}, {output, name}}), file,
                    {folder ? file : name, '(' + input->names.front() + ')', '(' + output->names.front() + ')'});
      }
    }
  }
  EXPECT_GT(runs_, 100);
}

TEST_F(Outputs, ReplaceNoFileOfTheScene) {
  const std::map<std::string, Words> complete = {{"point", {"--at", "0", "0", "9", "--normal", "0", "0", "1"}},
                                                 {"view", {"--at", "0", "0", "9", "--normal", "0", "0", "1"}},
                                                 {"matrix", {}},
                                                 {"radiosity", {}},
                                                 {"render", {"--size", "2x2"}},
                                                 {"compare", {"--on", "floor", "--grid", "2x2", "--no-methods"}},
                                                 {"truth", {"--on", "floor", "--grid", "2x2", "--source", "lid"}},
                                                 {"convert", {}}};
  const Words kTold = {"is read (with SCENE)"};
  for (const CommandTable& command : command_tables()) {
    const OptionRow* scene = row_named(command, "SCENE");
    for (const OptionRow* output : rows_of(command)) {
      if (scene == nullptr || !is_written(*output) || output->names.front() == "--exr") continue;  // needs pixels
      ASSERT_TRUE(complete.contains(command.name)) << "say how exactff " << command.name << " is called";
      const bool folder = output->file->use == Use::kFolder;
      fs::create_directory(path("folder"));
      const std::string name = path("m" + extension_of(*output));
      std::vector<std::pair<std::string, std::string>> libraries;  // a file that the scene names, and the output's name
      if (folder) libraries.emplace_back(path("folder/m.csv"), path("folder"));
      if (!folder) libraries.emplace_back(name, name);
      if (output->file->beside == Beside::kMaterials) libraries.emplace_back(path("m.mtl"), path("m.obj"));
      if (output->file->beside == Beside::kJournal) libraries.emplace_back(name + ".part", name);
      if (output->file->beside == Beside::kScene) libraries.emplace_back(path("m_scene.vtp"), name);
      if (output->file->beside == Beside::kViewFactors) libraries.emplace_back(name + ".factors", name);
      for (const auto& [library, written] : libraries) {
        write_text(library, "# exactff \nnewmtl grey\nKd .5 .5 .5\n");
        const std::string relative = fs::relative(library, directory_.path()).string();
        write_text(path("s.obj"), "mtllib " + relative + "\nusemtl grey\n" + kScene);
        std::map<const OptionRow*, std::string> values = {{scene, path("s.obj")}, {output, written}};
        Words words = {command.name};
        for (const OptionRow* row : rows_of(command)) {
          if (row->required && row->file && !values.contains(row)) values[row] = path("other" + extension_of(*row));
          if (!values.contains(row)) continue;
          if (!is_positional(*row)) words.push_back(row->names.front());
          words.push_back(values[row]);
        }
        const Words& more = complete.at(command.name);
        words.insert(words.end(), more.begin(), more.end());
        const std::string bytes = text_of(library);
        const Words with_force = forced(command, *output, words);
        expect_refused(words, with_force.empty() ? kTold : Words{});  // otherwise, it may be that it exists
        expect_refused(with_force, kTold);
        EXPECT_EQ(text_of(library), bytes) << testing::PrintToString(words);
        fs::remove(library);
      }
    }
  }
  EXPECT_GT(runs_, 30);
}

TEST_F(Outputs, OfOneCommandAreDifferentFiles) {
  for (const CommandTable& command : command_tables()) {
    for (const OptionRow* a : rows_of(command)) {
      for (const OptionRow* b : rows_of(command)) {
        if (a >= b || !is_written(*a) || !is_written(*b)) continue;
        const bool folder = a->file->use == Use::kFolder || b->file->use == Use::kFolder;
        const std::string inside = folder ? path("out/x") : path("./out");
        const bool a_outside = a->file->use == Use::kFolder || !folder;
        expect_refused(line(command, {{a, a_outside ? path("out") : inside}, {b, a_outside ? inside : path("out")}}),
                       folder ? Words{"lies in the folder of the result"} : Words{a->names.front(), b->names.front()});
      }
    }
  }
  EXPECT_GT(runs_, 30);
  EXPECT_EQ(names_in(directory_.path()), std::set<std::string>{"stderr"});
}

TEST_F(Outputs, ReplaceNoFileByWhatIsKeptBesideThem) {
  for (const std::string name : {"s.whole", "s.part", "s.factors", "s.factors.part", "s.again.part"}) {
    write_text(path(name), kScene);
    EXPECT_EQ(run({"radiosity", path(name), "-o", path("s"), "--force"}), 2);  // nothing emits light, in any case
    EXPECT_EQ(error_.find("is read") != std::string::npos, name != "s.part") << error_;
    EXPECT_EQ(text_of(path(name)), kScene) << name;
    EXPECT_EQ(run({"truth", path(name), "--on", "floor", "--grid", "2x2", "--source", "lid", "-o", path("s"),
                   "--force"}) == 2,
              name == "s.whole" || name == "s.part")
        << error_;
    EXPECT_EQ(text_of(path(name)), kScene) << name;
    fs::remove(path(name));
  }
}

TEST_F(Outputs, WithTheNameOfAnotherFormatAreRefused) {
  for (const CommandTable& command : command_tables()) {
    for (const OptionRow* row : rows_of(command)) {
      if (!row->file || row->file->use != Use::kFile || flags::extensions_of(row->file->format).size() > 1) continue;
      const std::string file = path("m.xlsx");
      expect_refused(line(command, {{row, file}}),
                     {"m.xlsx: is named as a spreadsheet, and " + row->names.front() + " writes", extension_of(*row)});
    }
  }
  EXPECT_GT(runs_, 15);
}

TEST_F(Outputs, ReplaceNoFileOfAStudy) {
  fs::create_directory(path("folder"));
  const std::string receivers = "# exactff \nid,x,y,z,nx,ny,nz\na,.2,.2,0,0,0,1\n";
  write_text(path("folder/p.csv"), receivers);
  write_text(path("s.obj"), kScene);
  write_text(path("s.study"), "scene s.obj --receivers folder/p.csv --source lid --no-methods\n");
  expect_refused({"compare", path("s.study"), "-o", path("folder"), "--force"}, {"p.csv: is read (with SCENE)"});
  EXPECT_EQ(text_of(path("folder/p.csv")), receivers);
}

}  // namespace
}  // namespace exactff
