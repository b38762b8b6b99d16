// exactff matrix: view factors from patch to patch.
#include "exactff/matrix.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <system_error>
#include <utility>

#include "cli/commands.h"
#include "cli/output.h"
#include "cli/process.h"
#include "cli/view_factor_words.h"
#include "exactff/radiosity.h"
#include "exactff/version.h"
#include "flags/scene.h"
#include "flags/values.h"
#include "matrix/balanced.h"
#include "matrix/rows.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "vtk/vtk.h"

namespace exactff::cli {
namespace {

constexpr const char* kMatrixFooter =
    "F_ij is the share of the light leaving patch i, in all directions, that reaches patch j: the mean over i of\n"
    "the form factor from a point to j. Its interval is proved or estimated. 'zero' is proved. 'estimated' means\n"
    "that the error is an estimate, with all roundings in it. By cells, what each cell sees is proved, and the\n"
    "error comes from rules of quadrature. By points, which cost less behind many occluders, the interval comes\n"
    "from exact form factors at random points; it misses with a probability of at most 1e-6. If entries\n"
    "are wider than the accuracy, in this direction or from the other patch, a warning counts them, and the exit\n"
    "code is 3; a shard leaves both to exactff merge.\n"
    "With --claim certified, or --certify, every entry is 'zero' or 'certified': the remainder of the quadrature\n"
    "and all roundings are proved as well. It takes up to a few times as long, and less time if the accuracy is\n"
    "below 1e-9. With --backs and --to all,sky each row also has the share that meets backs of faces, and the share\n"
    "that meets nothing. Then it must add up to 1; if a row does not, the exit code is 1. Likewise if the bounds of\n"
    "the two directions of a pair contradict each other, with --both-directions. --two-sided wall adds the patch\n"
    "'wall (back)', for rows and columns.\n"
    "With -o, finished pairs are kept in FILE.part until FILE is complete; after an interruption, the same command\n"
    "with --resume continues from there. On several machines: `mpirun -n 4 exactff matrix ... -o FILE`, or separate\n"
    "jobs with --shard 1/4, 2/4, ... whose files `exactff merge` joins. With --resume and a complete FILE, also a\n"
    "merged one, the other files are made again. The bytes depend on none of this.\n"
    "Files of other programs have the patches in the order of the rows; the output says what a file loses. Where\n"
    "fronts of two patches overlap in one plane, such as a window and its wall, both count in full and rows exceed 1:\n"
    "a warning names them, and such a file is not written without --force.\n"
    "--balance chooses the nearest matrix within all intervals in which A_i F_ij and A_j F_ji are the same double and\n"
    "every row adds up to 1 within 2^-51 (the output says how far). If there is none, a warning names the rows or\n"
    "pairs that prove it, and the exit code is 1. -o then has the column 'balanced', and the table and all other\n"
    "files have its values.\n"
    "--sum NAME, after --divide or --patches, adds the column '(sum NAME)': the sum over all columns NAME:1, NAME/2,\n"
    "... or over those of a pattern. Bounds are the sums of theirs, rounded outward; the claim is the weakest of\n"
    "theirs. It is accurate if it is no wider than the accuracy, and no warning counts it. It is in -o and --npz, and\n"
    "not in files of other programs. Finished pairs are not kept; compute FILE first, then give --matrix FILE --sum.\n"
    "--matrix FILE takes the entries from a file of `exactff matrix SCENE -o FILE`, with all columns that are needed.\n"
    "--exchange FILE holds Gebhart's factors: of what a patch emits, the share that another one absorbs after all\n"
    "bounces, with the emissivity 1 - Kd; backs and the sky are black. Bounds follow from those of the view factors,\n"
    "values from the balanced matrix if --balance is given. 'conductor' is emissivity times area times this factor.\n"
    "\n"
    "Examples:\n"
    "  exactff matrix data/scenes/cornell_box.obj --from light --to 'floor,*_block' --accuracy 1e-4\n"
    "  exactff matrix data/scenes/formats/test4.vs3 --backs --to all,sky --npz build/factors.npz";

constexpr std::size_t kMostShown = 12;  // rows and columns of the printed table

std::string flag_of(const matrix::ProgramFormat& format) { return "--" + std::string(format.name); }

struct MatrixArguments : KeptRun {
  flags::SceneArguments scene;
  std::vector<std::string> from{"all"}, to{"all"}, two_sided, sums;
  matrix::Options options;
  bool plain = false, balance = false;
  std::string matrix;  // a file
  std::string csv, npz, vtk, exchange;
  std::vector<std::string> programs = std::vector<std::string>(matrix::program_formats().size());  // files, or empty
  std::string zone = "Zone 1";
  std::string shard;

  // Whether every row must have all that it sees.
  [[nodiscard]] bool needs_all() const { return balance || exchanges(); }
  [[nodiscard]] bool exchanges() const {
    const auto given = program_files();
    return !exchange.empty() || std::ranges::any_of(given, [](const auto& one) { return one.first->of_conductors; });
  }
  // Those that are given.
  [[nodiscard]] std::vector<std::pair<const matrix::ProgramFormat*, std::string>> program_files() const {
    std::vector<std::pair<const matrix::ProgramFormat*, std::string>> given;
    for (std::size_t k = 0; k < programs.size(); ++k) {
      if (!programs[k].empty()) given.emplace_back(&matrix::program_formats()[k], programs[k]);
    }
    return given;
  }
  // A pipe or a device has no journal.
  [[nodiscard]] bool keeps_work() const {
    std::error_code ignored;
    return !csv.empty() && !balance && matrix.empty() && sums.empty() &&
           (!std::filesystem::is_other(csv, ignored) || resume || !shard.empty());
  }
};

// The columns that are no patch: their names, and a factor for each row.
std::vector<std::pair<std::string, const std::vector<ViewFactor>*>> further_columns(const matrix::Matrix& matrix) {
  std::vector<std::pair<std::string, const std::vector<ViewFactor>*>> columns;
  const std::pair<std::string_view, const std::vector<ViewFactor>*> shares[] = {
      {matrix::kBack, &matrix.back}, {matrix::kOpen, &matrix.open}, {matrix::kBuried, &matrix.buried}};
  for (const auto& [name, factors] : shares) {
    if (!factors->empty()) columns.emplace_back(name, factors);
  }
  for (const matrix::GroupSum& sum : matrix.sums) columns.emplace_back(text::printable(name_of(sum)), &sum.factors);
  return columns;
}

void print_plain(const Scene& scene, const matrix::Matrix& matrix, bool with_values) {
  const matrix::Factors& all = matrix.factors;
  const auto further = further_columns(matrix);
  const auto print = [&](std::size_t i, const std::string& to, const ViewFactor& f) {
    std::cout << shown_name(scene, all.from[i]) << '\t' << to << '\t' << text::shortest(f.lower) << '\t'
              << text::shortest(f.upper) << '\t' << to_string(f.claim) << '\t' << to_string(f.way);
    if (with_values) std::cout << '\t' << text::shortest(f.value);
    std::cout << '\n';
  };
  for (std::size_t i = 0; i < all.from.size(); ++i) {
    for (std::size_t j = 0; j < all.to.size(); ++j) print(i, shown_name(scene, all.to[j]), all.at(i, j));
    for (const auto& [name, factors] : further) print(i, name, (*factors)[i]);
  }
}

std::string factor_text(const ViewFactor& f) {
  if (f.claim == Claim::kZero) return "0";
  return text::rounded(f.value, 6) + (f.accurate ? "" : " *");
}

void print_table(const Scene& scene, const matrix::Matrix& matrix) {
  const matrix::Factors& all = matrix.factors;
  const std::vector<matrix::Sum> sums = clipped_row_sums(scene, matrix);
  const std::size_t columns = std::min(all.to.size(), kMostShown), rows = std::min(all.from.size(), kMostShown);
  TextTable table;
  table.add_column("from \\ to");
  for (std::size_t j = 0; j < columns; ++j) table.add_column(shown_name(scene, all.to[j]));
  const auto further = further_columns(matrix);
  for (const auto& [name, factors] : further) table.add_column(name);
  table.add_column("sum of row");
  for (std::size_t i = 0; i < rows; ++i) {
    std::vector<std::string> cells{shown_name(scene, all.from[i])};
    for (std::size_t j = 0; j < columns; ++j) cells.push_back(factor_text(all.at(i, j)));
    for (const auto& [name, factors] : further) cells.push_back(factor_text((*factors)[i]));
    cells.push_back(text::interval(sums[i].lower, sums[i].upper));
    table.add_row(std::move(cells));
  }
  table.print(std::cout);
  if (rows < all.from.size() || columns < all.to.size()) {
    std::cout << "\n(the first " << rows << " of " << all.from.size() << " rows and " << columns << " of "
              << all.to.size() << " columns; --plain and -o have all)\n";
  }
}

// Whether all rows hold 1. Those that need not are not tested.
bool test_rows(const MatrixArguments& args, const Scene& scene, const matrix::Matrix& matrix) {
  const std::vector<std::string> reasons = reasons_against_one(scene, matrix);
  if (!reasons.empty()) {
    if (!args.plain) std::cout << "\nRows need not add up to 1: " << text::enumerate(reasons) << ".\n";
    return true;
  }
  const std::vector<matrix::Sum> sums = row_sums(matrix);
  bool all = true;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (sums[i].lower <= 1.0 && 1.0 <= sums[i].upper) continue;
    all = false;
    print_warning("the row of " + scene.name_of(matrix.factors.from[i]) + " adds up to between " +
                      text::shortest(sums[i].lower) + " and " + text::shortest(sums[i].upper),
                  has_estimates(matrix, i) ? "an estimated entry of it misses its interval, or a bound does not hold"
                                           : "with back and open it must add up to 1, so a bound of it does not hold",
                  "please report the scene");
  }
  if (all && !args.plain) std::cout << "\nEvery row adds up to 1 within its bounds.\n";
  return all;
}

// Whether the intervals of the two directions of every pair have a number in common.
bool test_reciprocity(const MatrixArguments& args, const Scene& scene, const matrix::Matrix& matrix) {
  if (!args.options.factors.both_directions) return true;
  const matrix::Reciprocity found = reciprocity(matrix);
  const auto pair_name = [&](const matrix::Reciprocity::Pair& pair) {
    return scene.name_of(matrix.factors.from[pair.row]) + " and " + scene.name_of(matrix.factors.to[pair.column]);
  };
  if (!args.plain) {
    std::cout << "\nReciprocity, A_i F_ij = A_j F_ji, of " << text::counted(found.pairs, "pair")
              << " computed both ways";
    if (found.worst) {
      std::cout << ": they differ at worst by " << text::short_number(found.worst->distance, 2) << " of a radius of "
                << text::short_number(found.worst->radius, 2) << " (" << text::printable(pair_name(*found.worst))
                << "; as factors from the larger patch)";
    }
    std::cout << ".\n";
  }
  for (const matrix::Reciprocity::Pair& pair : found.apart) {
    print_warning(
        "the two directions between " + pair_name(pair) + " contradict each other",
        "A_i F_ij and A_j F_ji are equal, but their bounds have no number in common, so a bound does not hold",
        "please report the scene");
  }
  return found.apart.empty();
}

// --- Files ---

// What only a file with a journal can have, and what a part of the pairs cannot give.
void check_shard_and_resume(const MatrixArguments& args) {
  if (args.csv.empty() && (args.resume || !args.shard.empty())) {
    text::refuse(std::string(args.resume ? "--resume" : "--shard") + " is given without -o",
                 "finished pairs are kept beside the file of -o", "name a file, for example -o factors.csv");
  }
  if ((args.balance || !args.matrix.empty() || !args.sums.empty()) && (args.resume || !args.shard.empty())) {
    text::refuse(std::string(args.resume ? "--resume" : "--shard") + " is given with " +
                     (args.balance           ? "--balance"
                      : !args.matrix.empty() ? "--matrix"
                                             : "--sum"),
                 "finished pairs are kept of a matrix as it is computed",
                 "compute it first by -o FILE, and then give --matrix FILE" + std::string(args.balance ? " --balance"
                                                                                          : !args.sums.empty()
                                                                                              ? " --sum NAME"
                                                                                              : " without this flag"));
  }
  if (args.shard.empty()) return;
  std::vector<std::pair<std::string, bool>> all{{"--plain", args.plain},
                                                {"--npz", !args.npz.empty()},
                                                {"--vtk", !args.vtk.empty()},
                                                {"--exchange", !args.exchange.empty()}};
  for (const auto& [format, file] : args.program_files()) all.emplace_back(flag_of(*format), true);
  for (const auto& [flag, given] : all) {
    if (!given) continue;
    text::refuse(
        flag + " is given with --shard", "a shard has only a part of the entries",
        "after exactff merge, run this command without --shard, with --resume and -o FILE for the merged file");
  }
}

void check_outputs(const MatrixArguments& args) {
  check_shard_and_resume(args);
  if (!args.exchange.empty()) require_table_file(args.exchange);
  if (args.keeps_work()) {
    jobs::require_free(args.csv, args.existing());
  } else if (!args.csv.empty()) {
    require_free_file(args.csv, args.force);
  }
  std::vector<files::NamedFile> files{{"--npz", args.npz}, {"--vtk", args.vtk}, {"--exchange", args.exchange}};
  for (const auto& [format, file] : args.program_files()) {
    files.push_back({flag_of(*format), file});
    if (format->name != "openfoam") continue;
    for (const std::string_view name : matrix::kOpenFoamFiles) {
      files.push_back({std::string(name) + " of --openfoam", std::filesystem::path(file).replace_filename(name)});
    }
  }
  check_output_files(files, args.existing() != jobs::Existing::kRefuse);
}

void check_row_of_vtk(const MatrixArguments& args, const std::vector<Selection>& from,
                      const std::vector<Selection>& to) {
  if (args.vtk.empty() || (from.size() == 1 && !to.empty())) return;
  text::refuse("--vtk is given, and " + (to.empty() ? "no column is a patch" : text::counted(from.size(), "row")),
               "the file shows one row on the patches of the scene",
               to.empty() ? "name patches by --to" : "name one patch by --from");
}

void write_program_file(const matrix::ProgramFormat& format, const matrix::Square& square, const std::string& file) {
  for (const auto& [path, text] : files_of(format, square, file)) write_whole_file(path, text);
}

void write_files(const MatrixArguments& args, const Scene& scene, const matrix::Matrix& matrix) {
  if (!args.vtk.empty()) write_vtk(scene, matrix, args.vtk);
  for (const auto& [format, file] : args.program_files()) {
    if (!format->of_conductors) write_program_file(*format, square_of(*format, scene, matrix, args.zone), file);
  }
}

void print_files(const MatrixArguments& args) {
  const std::vector<std::pair<const char*, const std::string*>> files = {
      {"Matrix", &args.csv}, {"NumPy file", &args.npz}, {"VTK file", &args.vtk}, {"Exchange factors", &args.exchange}};
  for (const auto& [what, file] : files) {
    if (!file->empty()) std::cout << what << ": " << text::printable(*file) << '\n';
  }
  for (const auto& [format, file] : args.program_files()) {
    std::cout << format->program << " file: " << text::printable(file) << " (without " << format->lost << ")\n";
  }
}

// Programs for heat take the rows as they are, and would make energy of what exceeds 1.
void check_overlaps(const MatrixArguments& args, const Scene& scene, const std::vector<Selection>& to) {
  std::optional<Problem> overlaps = problem_of_overlaps(scene, to);
  if (!overlaps) return;
  if (!args.force && !args.program_files().empty()) {
    overlaps->why = "a file for another program with such rows makes energy, and was not written";
    overlaps->suggestion += "; --force writes it all the same";
    throw InputError(std::move(*overlaps));
  }
  print_warnings(std::span(&*overlaps, 1));
}

// Before anything that takes time, what the files cannot hold is refused.
void check_content(const MatrixArguments& args, const Scene& scene, const std::vector<Selection>& from,
                   const std::vector<Selection>& to) {
  check_row_of_vtk(args, from, to);
  check_overlaps(args, scene, to);
  matrix::Matrix empty{{from, to, std::vector<ViewFactor>(from.size() * to.size())}, {}, {}, {}};
  for (const auto& [format, file] : args.program_files()) {
    (void)format->texts(square_of(*format, scene, empty, args.zone));
  }
  if (args.exchanges() && (from != radiosity::patches_of(scene) || to != from)) {
    text::refuse("exchange factors are asked for, and not all patches are rows and columns, in their order",
                 "light bounces between all of them", "leave out --from and --to");
  }
  if (!args.exchange.empty()) radiosity::require_exchangeable(scene);
  for (const auto& [format, file] : args.program_files()) {
    if (format->of_conductors) radiosity::require_exchangeable(scene, format);
  }
  matrix::Matrix without_rows{{{}, to, {}}, {}, {}, {}};
  add_sums(scene, args.sums, args.options.factors.accuracy, without_rows);
  if (!args.balance) return;
  empty.back.resize(from.size());
  empty.open.resize(from.size());
  require_balanceable(scene, empty);
}

// A request and the scene that it refers to.
struct MatrixJob {
  Scene scene;
  matrix::Request request;
};

std::unique_ptr<MatrixJob> job_of(const MatrixArguments& args, const jobs::Team* team) {
  const jobs::Shard shard = shard_of(args.shard);
  auto job = std::make_unique<MatrixJob>(MatrixJob{load(args.scene, args.two_sided), {}});
  std::vector<std::string> to = args.to;
  matrix::Request& request = job->request;
  request.scene = &job->scene;
  request.options = args.options;
  request.options.open = flags::take_sky(job->scene, to) || args.needs_all();
  request.options.backs = args.options.backs || args.needs_all();
  if (args.options.threads == 0 && team != nullptr) request.options.threads = jobs::fair_threads(*team);
  request.from = flags::selections_named(job->scene, args.from);
  request.to = flags::selections_named(job->scene, to);
  request.shard = shard;
  check_content(args, job->scene, request.from, request.to);
  return job;
}

// Where edges are open, corners may only almost meet.
std::string words_on_time(const MatrixJob& job) {
  constexpr std::size_t kMostFaces = 10'000;  // of more, to look for open edges takes time
  const std::string words = words_on_speed(job.request);
  if (words.empty() || job.scene.faces().size() > kMostFaces || job.scene.open_edge_count() == 0) return words;
  return words + "; `exactff convert --weld`, if corners only almost meet (`exactff info` tells)";
}

matrix::Matrix compute(const MatrixArguments& args, MatrixJob& job) {
  if (!args.matrix.empty()) {
    return matrix_in_file(args.matrix, job.scene, job.request.from, job.request.to, job.request.options.factors);
  }
  const InterruptWatch watch("exactff: interrupted; nothing was written\n");
  LateNote note([&] { return words_on_time(job); });
  ProgressBar bar;
  const Hooks hooks = with_note(note, bar.hooks());
  const matrix::Request& request = job.request;
  matrix::Matrix result = matrix::compute(job.scene, request.from, request.to, request.options, hooks);
  bar.clear();
  return result;
}

void print_summary(const MatrixArguments& args, const jobs::Summary& summary) {
  std::cout << text::counted(summary.rows, "pair") << " (" << summary.resumed << " of them were already computed)\n"
            << "Shard: " << text::printable(args.csv) << '\n';
  check_output(std::cout);
}

void print_balanced(const matrix::Matrix& matrix, const matrix::Balanced& balanced) {
  double most = 0.0, share = 0.0;
  const auto compare = [&](const ViewFactor& f, double value) {
    const double moved = std::abs(value - f.value);
    most = std::max(most, moved);
    if (moved > 0.0 && f.upper > f.lower) share = std::max(share, moved / (f.upper - f.lower));
  };
  for (std::size_t k = 0; k < balanced.entries.size(); ++k) compare(matrix.factors.entries[k], balanced.entries[k]);
  for (std::size_t i = 0; i < balanced.back.size(); ++i) compare(matrix.back[i], balanced.back[i]);
  for (std::size_t i = 0; i < balanced.open.size(); ++i) compare(matrix.open[i], balanced.open[i]);
  std::cout << "Balanced: entries moved by at most " << text::short_number(most, 2) << ", "
            << text::short_number(share, 2)
            << " of the widths of their intervals; in every pair the products A_i F_ij and\n"
            << "A_j F_ji are the same double; the rows add up to 1 within " << text::short_number(balanced.furthest, 2)
            << ".\n\n";
}

// Returns whether all of them have bounds.
bool write_exchange(const MatrixArguments& args, const MatrixJob& job, const matrix::Matrix& matrix) {
  ProgressBar bar;
  const Hooks hooks = bar.hooks();
  const radiosity::Exchange found = radiosity::exchange(job.scene, matrix, job.request.options.threads, hooks);
  bar.clear();
  if (!args.exchange.empty()) table::write(table_of(job.scene, found, job.request.options.factors), args.exchange);
  for (const auto& [format, file] : args.program_files()) {
    if (format->of_conductors) write_program_file(*format, square_of(*format, job.scene, found), file);
  }
  for (const radiosity::Exchange::Channel& channel : found.channels) {
    if (channel.is_bounded()) continue;
    print_warning("some exchange factors have no bound", channel.no_bound, channel.remedy);
    return false;
  }
  return true;
}

// The values of the finished file, or of no file at all.
int finish(const MatrixArguments& args, const MatrixJob& job, matrix::Matrix matrix) {
  const matrix::Options& options = job.request.options;
  const std::vector<Problem> wide = problems_of_width(job.scene, matrix, options.factors);
  print_warnings(wide);
  add_sums(job.scene, args.sums, options.factors.accuracy, matrix);
  std::optional<matrix::Balanced> balanced;
  if (args.balance) {
    balanced = matrix::balanced(job.scene, matrix);
    print_warnings(problems_of(job.scene, matrix, *balanced));
    if (!balanced->is_found()) return balanced->is_impossible() ? 1 : kNotAsAsked;
  }
  if (!args.keeps_work() && !args.csv.empty()) {
    write_whole_file(args.csv, csv_text(table_of(job.scene, matrix, options.factors, balanced ? &*balanced : nullptr)));
  }
  if (!args.npz.empty()) write_npz(job.scene, matrix, args.npz, balanced ? &*balanced : nullptr);
  if (balanced && !args.plain) print_balanced(matrix, *balanced);
  if (balanced) matrix = with_values(std::move(matrix), *balanced);
  write_files(args, job.scene, matrix);
  const bool bounded = !args.exchanges() || write_exchange(args, job, matrix);
  args.plain ? print_plain(job.scene, matrix, args.balance) : print_table(job.scene, matrix);
  const bool rows_hold = test_rows(args, job.scene, matrix),
             directions_agree = test_reciprocity(args, job.scene, matrix);
  if (!args.plain) print_files(args);
  check_output(std::cout);
  if (!rows_hold || !directions_agree) return 1;
  return wide.empty() && bounded ? 0 : kNotAsAsked;
}

int write(const MatrixArguments& args, jobs::Team* team) {
  check_outputs(args);
  if (!args.keeps_work()) {
    const std::unique_ptr<MatrixJob> job = job_of(args, nullptr);
    matrix::Matrix matrix = compute(args, *job);
    return finish(args, *job, std::move(matrix));
  }
  Narrator narrator("pair");
  jobs::Summary summary;
  std::unique_ptr<MatrixJob> job;
  const bool done = narrator.is_done(args.csv, [&] {
    job = job_of(args, team);
    const InterruptWatch watch(words_of_interruption("pair", args.csv));
    LateNote note([&] { return words_on_time(*job); });
    summary = matrix::write(job->request, args.csv, args.existing(), with_note(note, narrator.hooks(kNeverSlow)), team);
  });
  if (!done) return exit_code_of_interruption();
  narrator.clear();
  if (args.shard.empty()) return finish(args, *job, matrix::read(job->request, args.csv));
  print_summary(args, summary);
  return 0;
}

int follow(const MatrixArguments& args, jobs::Team& team) {
  std::unique_ptr<MatrixJob> job;
  const auto request = [&] {
    job = job_of(args, &team);
    return job->request;
  };
  return matrix::follow(team, request, {.cancelled = is_interrupted, .slow_seconds = kNeverSlow});
}

// Under mpirun only rank 0 has the standard input, and only a file with a journal is computed together.
void check_flags_of_a_team(const MatrixArguments& args) {
  if (args.scene.from_standard_input()) {
    text::refuse("- stands for standard input", "several processes under mpirun cannot share it",
                 "name a file, or run exactff without mpirun");
  }
  if (args.keeps_work()) return;
  text::refuse("several processes were started together, and -o names no file",
               "they share the work by the journal of that file", "give -o FILE.csv, or run exactff without mpirun");
}

int run(const MatrixArguments& args) {
  return run_alone_or_in_team({.row = "pair",
                               .refuse = [&] { check_flags_of_a_team(args); },
                               .write = [&](jobs::Team* team) { return write(args, team); },
                               .follow = [&](jobs::Team& team) { return follow(args, team); }});
}

void add_outputs(CLI::App& command, MatrixArguments& args) {
  flags::add_written(command, "-o,--output", args.csv, "Write a CSV file", flags::Format::kCsv,
                     flags::Beside::kJournal);
  flags::add_written(command, "--npz", args.npz, "Write the arrays of a sparse matrix for NumPy and SciPy",
                     flags::Format::kNpz);
  flags::add_written(command, "--vtk", args.vtk,
                     "Write the one row that --from names, on the scene, as NAME.vtp or NAME.vtu", flags::Format::kVtk);
  flags::add_written(command, "--exchange", args.exchange,
                     "Write exchange factors over all bounces and radiative conductors, with bounds, as CSV, .npz or "
                     ".jsonl; computes backs and the sky, too",
                     flags::Format::kTable);
  for (std::size_t k = 0; k < args.programs.size(); ++k) {
    const matrix::ProgramFormat& one = matrix::program_formats()[k];
    const flags::Format format = one.name == "energyplus" ? flags::Format::kEnergyPlus
                                 : one.name == "moose"    ? flags::Format::kCsv
                                                          : flags::Format::kProgram;
    flags::add_written(command, flag_of(one), args.programs[k], std::string(one.help), format,
                       one.name == "openfoam" ? flags::Beside::kOpenFoam : flags::Beside::kNothing);
  }
  flags::add_value(command, "--zone", args.zone, "TEXT", "Name of EnergyPlus' zone")
      ->needs("--energyplus")
      ->capture_default_str();
  flags::add_value(command, "--shard", args.shard, "I/N",
                   "Compute only part I of N, for exactff merge: 1/4 is the first of four");
  args.add_to(command, "Start again and replace existing files; write those for other programs even if fronts overlap");
}

}  // namespace

Command add_matrix(CLI::App& app) {
  auto args = std::make_shared<MatrixArguments>();
  CLI::App* command = app.add_subcommand("matrix", "Compute view factors from patch to patch");
  command->footer(kMatrixFooter);
  args->scene.add_to(*command);
  args->scene.add_divide_to(*command);
  flags::add_value(*command, "--from", args->from, "NAME",
                   "Rows: names of patches or faces, separated by commas, or all; * ? [...] as in file names")
      ->capture_default_str();
  flags::add_value(*command, "--to", args->to, "NAME", "Columns, in the same way; sky is what is open")
      ->capture_default_str();
  command->add_flag("--backs", args->options.backs, "Also compute what meets the backs of faces");
  flags::add_value(*command, "--two-sided", args->two_sided, "NAME", kTwoSidedHelp);
  CLI::Option* both = command->add_flag("--both-directions", args->options.factors.both_directions,
                                        "Compute F_ij and F_ji apart, and compare A_i F_ij with A_j F_ji");
  CLI::Option* accuracy =
      command
          ->add_option("--accuracy", args->options.factors.accuracy, "Largest width of an entry, for F_ij and for F_ji")
          ->capture_default_str();
  CLI::Option* budget = command->add_option("--budget", args->options.factors.budget, kBudgetHelp)
                            ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 32))
                            ->capture_default_str();
  const ClaimOptions claims = add_claim(*command, args->options.factors.certify);
  flags::add_read(*command, "--matrix", args->matrix, "Take the entries from this file of exactff matrix")
      ->excludes(accuracy)
      ->excludes(budget)
      ->excludes(claims.claim)
      ->excludes(claims.certify)
      ->excludes(both);
  CLI::Option* sum = flags::add_value(*command, "--sum", args->sums, "NAME",
                                      "Also the column (sum NAME): all columns of a divided patch or pattern");
  command
      ->add_flag("--balance", args->balance,
                 "Choose values within all intervals so that A_i F_ij = A_j F_ji and every row adds up to 1; computes "
                 "backs and the sky, too")
      ->excludes(sum);
  command->add_flag(
      "--plain", args->plain,
      "Print a line for each entry: FROM, TO, LOWER, UPPER, CLAIM, WAY, with tabs; by --balance also VALUE");
  add_outputs(*command, *args);
  flags::add_threads(*command, args->options.threads);
  return {command, [args] { return run(*args); }};
}

}  // namespace exactff::cli
