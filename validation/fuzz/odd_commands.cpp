#include "fuzz/odd_commands.h"

#include <algorithm>
#include <cctype>
#include <regex>
#include <span>
#include <string_view>

#include "cli/commands.h"
#include "exactff/methods.h"
#include "exactff/models.h"
#include "stress/stress.h"

namespace exactff::validation {

using cli::CommandTable;
using cli::OptionRow;
using generate::Random;

namespace {

// Within the limits, but small, because the work grows with the value.
std::string small_setting(const SettingSpec& spec, Random& random) {
  if (random.one_in(20)) return odd_number(random);
  if (!spec.words.empty()) return one_of(random, spec.words);
  const double high = std::min(spec.highest, std::max(spec.lowest, 1.0) * 8.0);
  if (std::holds_alternative<double>(spec.fallback)) {
    return generate::to_text(random.one_in(4) ? spec.lowest : random.between(spec.lowest, high));
  }
  const auto multiple = static_cast<double>(spec.multiple_of);
  const double steps = std::max(0.0, (high - spec.lowest) / multiple);
  return generate::to_text(spec.lowest +
                           multiple * static_cast<double>(random.below(static_cast<std::size_t>(steps) + 1)));
}

// NAME or NAME:SETTING=VALUE,...
std::string with_settings(const std::string& name, std::span<const SettingSpec> specs, bool all, Random& random) {
  std::string text = name;
  for (const SettingSpec& spec : specs) {
    if (!all && random.one_in(2)) continue;
    text += (text.find(':') == std::string::npos ? ':' : ',') + spec.name + '=' + small_setting(spec, random);
  }
  return text;
}

std::string odd_method(Random& random) {
  const methods::Method* method = one_of(random, methods::all_methods());
  return with_settings(method->name, method->settings, true, random);
}

// Every setting given: the defaults are for large scenes.
std::string odd_model(Random& random) {
  const models::Model* model = one_of(random, models::all_models());
  return '@' + with_settings(model->name, model->settings, true, random);
}

std::string small_whole(Random& random, int low, int high) {
  return random.one_in(25) ? odd_number(random) : std::to_string(random.integer(low, high));
}

std::vector<std::string> words_in(const std::string& text) {
  std::vector<std::string> words(1);
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-') {
      words.back() += c;
    } else if (!words.back().empty()) {
      words.emplace_back();
    }
  }
  std::erase(words, "");
  return words;
}

bool contains_any(const std::string& text, std::initializer_list<std::string_view> words) {
  return std::ranges::any_of(words, [&](std::string_view word) { return text.find(word) != std::string::npos; });
}

// Draws the words of one command.
class CommandWriter {
 public:
  CommandWriter(const CommandTable& table, const OddInputs& inputs, Random& random)
      : table_(table), inputs_(inputs), random_(random) {}

  Words write() {
    words_.push_back(table_.name);
    for (const OptionRow& row : table_.positionals) {
      if (!random_.one_in(60)) add_values(row);
    }
    if (random_.one_in(8)) shuffle_later_ = true;
    add_receivers();
    for (const OptionRow& row : table_.options) add_option(row);
    keep_company();
    if (shuffle_later_ && !table_.positionals.empty() && words_.size() > 1) {
      std::rotate(words_.begin() + 1, words_.begin() + 2, words_.end());  // the first of them last
    }
    if (random_.one_in(80))
      words_.push_back(one_of<std::string>(random_, {"--help", "--version", "--nonsense", "-x", "--", ""}));
    return std::move(words_);
  }

 private:
  // If a command needs receivers, one of these options gives them; several together are refused.
  static bool places_receivers(const OptionRow& row) {
    return contains_any(row.names.back(), {"--grid", "--vertices", "--centres", "--samples", "--receivers"});
  }
  // Without these options, a command takes seconds.
  static bool keeps_work_small(const OptionRow& row) {
    static const std::vector<std::string> kFrugal = {
        "--family",           "--eps-b",         "--rays",         "--seeds",   "--method-seeds",
        "--method-receivers", "--method-budget", "--sweep-budget", "--threads", "--size"};
    return std::ranges::find(kFrugal, row.names.back()) != kFrugal.end();
  }

  void add_receivers() {
    std::vector<const OptionRow*> places;
    for (const OptionRow& row : table_.options) {
      if (places_receivers(row)) places.push_back(&row);
    }
    if (places.empty() || random_.one_in(30)) return;
    const OptionRow& chosen = *one_of(random_, places);
    give(chosen);
    if (chosen.names.back() == "--receivers") {
      if (random_.one_in(2)) words_.insert(words_.end(), {"--on", "auto"});
      return;
    }
    for (const OptionRow& row : table_.options) {
      if (row.names.back() == "--on") give(row);
    }
  }

  void add_option(const OptionRow& row) {
    const std::string& name = row.names.back();
    if (name == "--help") return;
    const bool told =
        places_receivers(row) || (name == "--on" && words_.front() != "point" && words_.front() != "view");
    const std::size_t rarity = row.required ? 1 : keeps_work_small(row) ? 1 : told ? 40 : row.value.empty() ? 5 : 7;
    const bool wanted = name == "--family" ||  // all of them take half a minute
                        (row.required || keeps_work_small(row) ? !random_.one_in(100) : random_.one_in(rarity));
    if (wanted) give(row);
  }

  [[nodiscard]] bool has_any(std::initializer_list<std::string_view> flags) const {
    return std::ranges::any_of(flags,
                               [&](std::string_view flag) { return std::ranges::find(words_, flag) != words_.end(); });
  }

  // Some options are refused without another one.
  void keep_company() {
    // By default, a matrix may take many minutes.
    if (table_.name == "matrix" && has_any({"--zone"})) words_.insert(words_.end(), {"--energyplus", "out/zone.txt"});
    if ((table_.name == "matrix" || table_.name == "radiosity") && !has_any({"--budget"}))
      words_.insert(words_.end(), {"--budget", "20"});
    if (random_.one_in(20)) return;
    if (table_.name == "compare" && has_any({"--method"}) && !has_any({"--sweep"})) words_.emplace_back("--sweep");
    if (table_.name == "view") {
      if (has_any({"--projection", "--up"}) && !has_any({"--svg"}))
        words_.insert(words_.end(), {"--svg", "out/view.svg"});
      if (has_any({"--force"}) && !has_any({"--mesh"})) words_.insert(words_.end(), {"--mesh", "out/mesh.obj"});
    }
    if (table_.name == "render" || table_.name == "compare") {
      const bool needs_eye = table_.name == "compare" && has_any({"--up", "--fov"});
      for (const auto& [missing, other] : {std::pair("--eye", "--look"), std::pair("--look", "--eye")}) {
        if (has_any({missing}) || !(has_any({other}) || needs_eye)) continue;
        const std::string name = missing;
        give(*std::ranges::find_if(table_.options, [&](const OptionRow& row) { return row.names.back() == name; }));
      }
    }
    if (table_.name == "render") {
      if (has_any({"--strip"}) && !has_any({"--against"})) words_.insert(words_.end(), {"--against", quick_method()});
    }
    if (has_any({"--exr", "--position-layer", "--normal-layer"})) {
      std::ranges::replace(words_, "in/receivers.csv", "in/gbuffer.exr");
    }
  }

  void give(const OptionRow& row) {
    words_.push_back(one_of(random_, row.names));
    add_values(row);
    if (row.repeats && random_.one_in(4)) {
      words_.push_back(row.names.back());
      add_values(row);
    }
  }

  // Rarely one value too few.
  void add_values(const OptionRow& row) {
    int count = row.most_values > row.least_values ? random_.integer(row.least_values, std::min(3, row.most_values))
                                                   : row.least_values;
    if (count > 0 && random_.one_in(100)) --count;
    for (int i = 0; i < count; ++i) words_.push_back(value_of(row, i));
  }

  std::string value_of(const OptionRow& row, int place) {
    const std::string& kind = row.value;
    if (!row.choices.empty()) return random_.one_in(40) ? odd_name(random_) : one_of(random_, row.choices);
    if (kind.starts_with("SCENE")) return scene();
    if (kind == "OUT") return written_scene();
    if (kind == "X Y Z") return coordinate(inputs_.scene.point, place);
    if (kind == "NX NY NZ") return coordinate(inputs_.scene.normal, place);
    if (kind.starts_with("NAME[:K]")) return patch();
    if (kind.starts_with("UxV")) return grid();
    if (kind == "COMMAND") return random_.one_in(4) ? odd_name(random_) : one_of(random_, row.words);
    if (kind == "WxH") return image_size();
    if (kind.starts_with("METHOD") && table_.name != "compare") return quick_method();
    if (kind.starts_with("METHOD")) return random_.one_in(20) ? odd_name(random_) : odd_method(random_);
    if (kind == "DIR") return random_.one_in(20) ? odd_place() : "out/folder";
    if (row.completion == cli::Completion::kFiles && kind != "TEXT") return file(row);
    if (kind == "SHARE=LIMIT") return number() + (random_.one_in(30) ? "" : "=") + number();
    if (kind == "I/N")
      return one_of<std::string>(
          random_, {"1/1", "1/2", "2/2", "2/3", "0/1", "3/2", "1/", "/", "x/y", "1/18446744073709551616"});
    if (kind == "X,Y,Z" || kind == "NX,NY,NZ")
      return one_of<std::string>(random_, {"x,y,z", "x,y", "nx,ny,nz", "\"x\",y,z", "\"", "x,x,x"});
    if (kind == "N" || kind == "S" || kind == "INT" || kind == "UINT") return whole(row);
    if (contains_any(kind, {"SECONDS", "LIMIT", "DISTANCE", "NUMBER", "SHARE", "FLOAT", "DEGREES", "LENGTH"}))
      return number();
    return word(row);
  }

  std::string scene() {
    if (random_.one_in(6)) return odd_model(random_);
    if (table_.name == "compare" && random_.one_in(6)) return "in/run.study";
    if (random_.one_in(8)) return one_of<std::string>(random_, {"in/scene.ply", "in/scene.stl", "in/scene.vs3"});
    return random_.one_in(40) ? odd_place() : "in/scene.obj";
  }

  std::string written_scene() {
    if (random_.one_in(20)) return odd_place();
    return "out/scene" + one_of<std::string>(random_, {".obj", ".ply", ".stl", ".off", ".vs3", ".dae"});
  }

  // Places where no file can be read or written, or should not be.
  std::string odd_place() {
    return one_of<std::string>(random_, {"in", "/dev/null", "/dev/full", "nowhere/at/all", "", ".", "in/scene.obj/x",
                                         "out/" + odd_name(random_), "@", "@nothing", "in/truth.csv", "out"});
  }

  std::string coordinate(const Vec3& v, int place) {
    if (random_.one_in(25)) return odd_number(random_);
    return generate::to_text(place == 0 ? v.x : place == 1 ? v.y : v.z);
  }

  std::string patch() {
    if (random_.one_in(25)) return odd_name(random_);
    if (random_.one_in(8)) return "all";
    const std::string name = random_.one_in(2) ? inputs_.scene.source : one_of(random_, inputs_.scene.patches).name;
    return name + (random_.one_in(6) ? ":" + small_whole(random_, 1, 2) : "");
  }

  std::string grid() {
    if (random_.one_in(15)) return odd_number(random_) + "x" + odd_number(random_);
    return std::to_string(random_.integer(1, 4)) + 'x' + std::to_string(random_.integer(1, 4));
  }

  std::string image_size() {
    if (random_.one_in(15)) return odd_number(random_) + "x" + odd_number(random_);
    return std::to_string(random_.integer(1, 6)) + 'x' + std::to_string(random_.integer(1, 6));
  }

  // For every pixel, without a budget.
  std::string quick_method() {
    return one_of<std::string>(
        random_, {"hemicube:resolution=8", "adaptive:eps_B=0.5,rays=2", "nettle", "wallace", "area-sampling:samples=4",
                  "exact", "hemicube:resolution=3", odd_name(random_)});
  }

  // An output if the description says that something is written there.
  std::string file(const OptionRow& row) {
    static const std::regex kWritten(R"(\b([Ww]rite|[Dd]raw|[Rr]ecord)\b)");
    if (random_.one_in(30)) return odd_place();
    if (table_.name == "render" && row.required)
      return one_of<std::string>(random_, {"out/image.png", "out/image.exr"});
    if (std::regex_search(row.description, kWritten)) return "out/" + written_name(row.names.back());
    if (row.names.back() == "TRUTH") return are_images_ ? "in/truth.exr" : "in/truth.csv";
    if (row.names.back() == "CANDIDATE") return are_images_ ? "in/candidate.exr" : "in/candidate.csv";
    if (row.names.back() == "SHARD") return "in/shard" + std::to_string(++shards_) + ".csv";
    if (row.names.back() == "--baseline") return "in/baseline.json";
    return random_.one_in(4) ? "in/gbuffer.exr" : "in/receivers.csv";
  }

  std::string written_name(const std::string& option) {
    if (option == "--npy") return "values.npy";
    if (option == "--exr") return "values.exr";
    if (option == "--npz") return "matrix.npz";
    if (option == "--view3d" || option == "--energyplus") return option.substr(2) + ".txt";
    if (option == "--error-image") return one_of<std::string>(random_, {"errors.exr", "errors.png", "errors.jpg"});
    if (option == "--mesh") return one_of<std::string>(random_, {"mesh.obj", "mesh.ply", "mesh.vtp", "mesh.png"});
    if (option == "--vtk") return one_of<std::string>(random_, {"cells.vtp", "cells.vtu", "cells.vtp", "cells.vtk"});
    if (option == "--junit") return "junit.xml";
    if (option == "--json" || option == "--write-baseline") return option.substr(2) + ".json";
    if (option == "--double" || option == "--bounds") return option.substr(2) + ".npy";
    return option == "--svg" || option == "--plot" ? option.substr(2) + ".svg" : "table.csv";
  }

  std::string number() {
    if (random_.one_in(10)) return odd_number(random_);
    return one_of<std::string>(random_, {"0", "1e-3", "0.01", "0.02", "1e-12", "0.5", "0.99", "1"});
  }

  // Below these values, the adaptive algorithm may need hours and all memory, as requested.
  std::string tolerance() {
    return one_of<std::string>(random_, {"1e-3", "0.01", "0.02", "0.5", "0.99", "1", "1e300"});
  }

  // "(1 to 4096)" in the description.
  std::string whole(const OptionRow& row) {
    static const std::regex kRange(R"(\((-?\d{1,9}) to (-?\d{1,9})\))");
    std::smatch range;
    if (!std::regex_search(row.description, range, kRange)) return small_whole(random_, row.value == "S" ? 0 : 1, 4);
    const int low = std::stoi(range[1]), high = std::stoi(range[2]);
    if (random_.one_in(40)) return std::to_string(low - 1);
    if (random_.one_in(40)) return std::to_string(high + 1);
    return small_whole(random_, low, std::min(high, std::max(low * 4, 4)));
  }

  // Lists and names: names from the description, numbers, and families.
  std::string word(const OptionRow& row) {
    if (row.names.back() == "--family") return std::string(one_of(random_, stress::all_families()).name);
    if (row.names.back() == "--rays" || row.names.back() == "--seeds")
      return random_.one_in(4) ? "1,4" : small_whole(random_, 1, 4);
    if (row.names.back() == "--title") return odd_name(random_);
    if (row.value == "LAYER")
      return one_of<std::string>(random_, {"position", "normal", "P", "normal", "Nrmal", odd_name(random_)});
    if (contains_any(row.names.back(), {"column"}))
      return one_of<std::string>(random_,
                                 {"value", "receiver", "exact", "source", "other", "R", "view", odd_name(random_)});
    const std::vector<std::string> words = words_in(row.description);
    if (row.names.back().starts_with("--eps")) return tolerance() + (random_.one_in(4) ? "," + tolerance() : "");
    if (words.empty()) return number() + (random_.one_in(4) ? "," + number() : "");
    return random_.one_in(20) ? odd_name(random_) : one_of(random_, words);
  }

  const CommandTable& table_;
  const OddInputs& inputs_;
  Random& random_;
  Words words_;
  const bool are_images_ = random_.one_in(4);  // the files of check
  int shards_ = 0;
  bool shuffle_later_ = false;
};

const CommandTable& table_of(const cli::ProgramTable& program, std::string_view name) {
  return *std::ranges::find(program.commands, name, &CommandTable::name);
}

// Files that `truth` writes, for merge and check.
Words truth_into(const std::string& file, const OddInputs& inputs, Words more) {
  Words words = {
      "truth", "in/scene.obj", "--on", inputs.scene.source, "--centres", "--source", inputs.scene.source, "--threads",
      "1",     "-o",           file};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

std::vector<Words> preparation(const Words& command, const OddInputs& inputs, Random& random) {
  std::vector<Words> steps;
  if (command.front() == "merge" && !random.one_in(8)) {
    const long count =
        std::ranges::count_if(command, [](const std::string& word) { return word.starts_with("in/shard"); });
    for (long k = 1; k <= count; ++k) {
      steps.push_back(truth_into("in/shard" + std::to_string(k) + ".csv", inputs,
                                 {"--shard", std::to_string(k) + '/' + std::to_string(count)}));
    }
  }
  if (command.front() == "check" && random.one_in(4)) {
    steps.push_back(truth_into("in/truth.csv", inputs, {"--force", "--unoccluded"}));
    steps.push_back(truth_into("in/candidate.csv", inputs, {"--force"}));
  }
  if (command.front() == "check" && std::ranges::find(command, "--baseline") != command.end() && !random.one_in(8)) {
    steps.push_back({"check", "in/truth.csv", "in/candidate.csv", "--write-baseline", "in/baseline.json"});
  }
  return steps;
}

}  // namespace

cli::ProgramTable own_table() {
  CLI::App app("", "exactff");
  (void)cli::add_commands(app);
  return cli::program_table(app);
}

std::vector<Words> odd_commands(const cli::ProgramTable& program, const OddInputs& inputs, Random& random) {
  // stress uses its own scenes, and merge reads only a few files.
  const std::vector<std::string> often = {"point", "point", "point", "view", "view",    "compare", "compare",  "truth",
                                          "truth", "check", "check", "info", "convert", "matrix",  "radiosity"};
  const std::string name =
      random.one_in(6) ? program.commands[random.below(program.commands.size())].name : one_of(random, often);
  if (random.one_in(150))
    return {one_of<Words>(
        random, {{"completion", "bash"}, {"completion"}, {"--help"}, {}, {name, "--help"}, {"help"}, {"help", name}})};
  const Words command = CommandWriter(table_of(program, name), inputs, random).write();
  std::vector<Words> steps = preparation(command, inputs, random);
  steps.push_back(command);
  return steps;
}

}  // namespace exactff::validation
