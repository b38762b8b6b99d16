// A matrix of view factors with what its rows see besides patches, and its files for other programs.
//
// A ray from a point of a patch meets the front of a face, the back of one, or nothing; from a part that is buried
// (scene.h), there is none. So the factors of a row to all patches, the factor to the backs, the factor to what is open
// and the share that is buried add up to 1, unless faces are transparent or fronts of different patches overlap in one
// plane. Each of the four is computed by itself.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exactff/jobs.h"
#include "exactff/scene.h"
#include "exactff/table.h"
#include "exactff/view_factors.h"

namespace exactff::matrix {

struct Options {
  ViewFactorOptions factors = {};
  bool backs = false;  // also compute what meets the backs of faces
  bool open = false;   // also compute what meets nothing
  int threads = 0;     // 0: all; does not affect the result
};

struct Factors {
  std::vector<Selection> from, to;
  std::vector<ViewFactor> entries;  // row by row: from `from[0]` to each of `to`, ...

  [[nodiscard]] const ViewFactor& at(std::size_t row, std::size_t column) const {
    return entries[row * to.size() + column];
  }
};

// The factors of each row to a group of columns together.
struct GroupSum {
  std::string name;                  // NAME of the column "(sum NAME)"
  std::vector<std::size_t> columns;  // of the group, each once, in their order
  std::vector<ViewFactor> factors;   // for each row
};

struct Matrix {
  Factors factors;
  // For each row: the factor to the backs of all faces that are not transparent, and the share that meets nothing.
  // Empty if not asked for. As strong as their claims. Where a front lies on a back, seen from the same side, the
  // front counts. The area_to of `open` means nothing.
  std::vector<ViewFactor> back, open;
  // For each row: the share of its area that is buried (scene.h), proved. Empty if nothing is, in all rows. Its area_to
  // means nothing.
  std::vector<ViewFactor> buried;
  std::vector<GroupSum> sums = {};  // see add_sums()
};

// All factors between two lists of patches, each as view_factor gives it alone. Throws what view_factor throws; and
// InputError for `open` in a scene so large that doubles end near it.
[[nodiscard]] Matrix compute(const Scene& scene, std::span<const Selection> from, std::span<const Selection> to,
                             const Options& options = {}, const Hooks& hooks = {});

// The sum of each row with its back, open and buried, rounded outward: an enclosure as strong as the row's weakest
// claim.
struct Sum {
  double lower = 0.0;
  double upper = 0.0;
};
[[nodiscard]] std::vector<Sum> row_sums(const Matrix& matrix);

// Adds, for each name, the sum of each row over the columns that Scene::select_all() finds by it. Bounds are sums of
// bounds, rounded outward, and at most 1 where the columns cannot overlap (as clipped rows); the value is the sum of
// the values, within them. The claim is the weakest one of the parts: zero only if all are. Accurate: the width is at
// most `accuracy`, which parts that all are accurate need not give. If parts come from points, the sum misses with a
// probability of at most 1e-6 for each of them. Throws InputError for a name that is unknown, given twice, or has a
// part that is no column.
void add_sums(const Scene& scene, std::span<const std::string> names, double accuracy, Matrix& matrix);

// Why rows need not add up to 1: "what meets backs is not computed". Empty: every row adds up to 1.
[[nodiscard]] std::vector<std::string> reasons_against_one(const Scene& scene, const Matrix& matrix);

// The two directions of pairs of patches, where both are in the matrix: A_i F_ij = A_j F_ji. A test of their bounds if
// they were computed apart (ViewFactorOptions::both_directions).
struct Reciprocity {
  struct Pair {
    std::size_t row = 0, column = 0;
    double distance = 0.0;  // of the two values of A_i F_ij / max(A_i, A_j), the factor from the larger patch
    double radius = 0.0;    // the sum of their radii
  };
  std::size_t pairs = 0;
  std::optional<Pair> worst;  // the largest distance / radius
  std::vector<Pair> apart;    // their intervals have no number in common: a bound does not hold
};
[[nodiscard]] Reciprocity reciprocity(const Matrix& matrix);

// --- Balanced ------------------------------------------------------------------------------------------------------

// A matrix for programs that need rows that close and reciprocity that holds, so that no energy is made.
struct Balanced {
  // As in Matrix: row by row, and for each row. Empty if there is no balanced matrix, or if none was found.
  std::vector<double> entries, back, open, buried;
  double furthest = 0.0;  // largest distance of the exact sum of a row from 1, rounded up: at most 2^-51

  // Why there is none, by the bounds. Rows as indices.
  struct Pair {
    std::size_t row = 0, column = 0;
  };
  std::vector<Pair> apart;  // pairs whose two directions have no number in common
  // Even with all their entries at their upper bounds, rows of `lacking` do not reach their areas; those of `exceeding`
  // exceed theirs with all entries at their lower bounds; of both together, a sum of rows misses a sum of areas by
  // `gap`, as a share of the areas of these rows.
  std::vector<std::size_t> lacking, exceeding;
  double gap = 0.0;
  Claim claim = Claim::kZero;  // the weakest one of the bounds that prove it; estimated: a fault is likely, not proved

  [[nodiscard]] bool is_found() const { return !entries.empty(); }
  [[nodiscard]] bool is_impossible() const { return !apart.empty() || !lacking.empty() || !exceeding.empty(); }
};

// The matrix nearest to the values in which every entry lies in its interval, and
//
// - A_i * F_ij == A_j * F_ji as products of doubles, each rounded once, in every pair (unless they underflow),
// - the exact sum of the doubles of a row, with back, open and buried, is 1 to within 2^-51, two ulps. It is mostly
//   within one; `furthest` has the largest distance (math.fsum of a row nearly always gives 1.0).
//
// If roundings do not allow both, as may happen where two groups of patches see only each other or where intervals are
// only some 1e-11 of their entries wide, no matrix is found.
//
// "Nearest": the sum of squared distances of A_i F_ij over the widths of their intervals is least, up to roundings. An
// entry whose two intervals have no two such doubles, since areas are rounded, may miss one by 2^-42 of itself. Depends
// neither on threads nor on the order of the patches, but on their names, which order the sums. Throws InputError
// unless rows and columns are the same patches and every row must add up to 1: the message has reasons_against_one().
[[nodiscard]] Balanced balanced(const Scene& scene, const Matrix& matrix);

// The matrix with these values in place of its own. Requires balanced.is_found().
[[nodiscard]] Matrix with_values(Matrix matrix, const Balanced& balanced);

// The scene with the backs of these patches or faces as patches of their own, named "NAME (back)": every face has a
// twin in its place that is turned round and has the same material; a face that is not planar and its twin consist of
// the same triangles. A face in several selections gets one twin. All patches and faces of `scene` keep their ids.
// Coplanar faces hide nothing from each other, so every other factor is the same number, and what met the backs meets
// the twins. Its interval may be another one, since twins take part in the search for what hides something. Throws
// InputError if there is a patch of such a name.
[[nodiscard]] Scene with_two_sided(const Scene& scene, std::span<const Selection> selections);

// The weaker of two claims, the one to be made of a sum.
[[nodiscard]] Claim weaker(Claim a, Claim b);

// --- Files ---------------------------------------------------------------------------------------------------------

// Names of the additional columns.
inline constexpr std::string_view kBack = "(back)";
inline constexpr std::string_view kOpen = "(open)";
inline constexpr std::string_view kBuried = "(buried)";
[[nodiscard]] std::string name_of(const GroupSum& sum);  // "(sum NAME)"

// A row for each entry: from,to,factor,lower,upper,claim,way,accurate,area_from,area_to,cells,event_cells,limit. The
// head has the options of the view factors and all else that the entries depend on.
// With a balanced matrix, each row also has the column `balanced`, and sums are left out.
[[nodiscard]] table::Table table_of(const Scene& scene, const Matrix& matrix, const ViewFactorOptions& options,
                                    const Balanced* balanced = nullptr);

// A matrix as its table has it: with names instead of patches, otherwise to the same bits.
struct NamedMatrix {
  std::string file;
  table::Head head;
  std::vector<std::string> from, to;           // `to` without the additional columns; sums are not read
  std::vector<ViewFactor> entries;             // row by row
  std::vector<ViewFactor> back, open, buried;  // for each row; empty if the table does not have them
  std::vector<std::size_t> lines;  // of all entries, in the order of the table: row by row, with back and open
};
// Reads what table_of gives, in any format. Throws one InputError with file:line for every problem.
[[nodiscard]] NamedMatrix read_named(const std::filesystem::path& file);
// The options with which the view factors of a table were computed, by its head.
[[nodiscard]] ViewFactorOptions options_of(const table::Head& head);

// A matrix that is computed by way of a journal (jobs.h). Keeps a reference to the scene.
struct Request {
  const Scene* scene = nullptr;
  std::vector<Selection> from, to;
  Options options;
  jobs::Shard shard;  // if not 1/1, the file holds the pairs of this shard, for merge()
};
// Computes the matrix and writes its table as CSV. Throws InputError if the request, the file or the journal is
// unusable, or if nothing can be written; throws Cancelled if the hooks cancel. Whatever is thrown, and even if the
// process is killed, the finished pairs in the journal stay valid.
jobs::Summary write(const Request& request, const std::filesystem::path& file,
                    jobs::Existing existing = jobs::Existing::kRefuse, const jobs::RowHooks& hooks = {});
// The matrix in the file that write() or merge() made for this request. Throws InputError if the file is damaged or of
// other patches.
[[nodiscard]] Matrix read(const Request& request, const std::filesystem::path& file);
// The same of a matrix that was read already.
[[nodiscard]] Matrix matrix_of(const Request& request, NamedMatrix named);

// Writes the arrays of a sparse matrix (CSR) for NumPy and SciPy: scipy.sparse.load_npz(path) gives the factors.
// `radius`, in the order of `data`: data - radius and data + radius are bounds. `claim` and `way` likewise. `from` and
// `to` are names; `area_from`, `area_to`; if computed, `back`, `back_radius`, `open`, `open_radius` for each row.
// Of sums: `sum_of`, the names, and row by row `sum` and `sum_radius`.
// Proved zeros are left out. The file appears complete or not at all. Throws InputError if it cannot be written.
// With a balanced matrix, `data`, `back`, `open` and `buried` have its values, and `factor` those of the matrix.
void write_npz(const Scene& scene, const Matrix& matrix, const std::filesystem::path& path,
               const Balanced* balanced = nullptr);

// Writes the factors of the first row and their bounds for ParaView (.vtp, .vtu), at the faces of the columns, NaN
// elsewhere. Requires a row. Throws InputError if the file cannot be written.
void write_vtk(const Scene& scene, const Matrix& matrix, const std::filesystem::path& file);

// --- Files of other programs ---

// A square of values between patches, with all that such files hold.
struct Square {
  const Scene* scene = nullptr;
  std::vector<Selection> patches = {};
  std::vector<double> areas = {}, values = {};                              // row by row
  std::vector<std::pair<std::string_view, std::vector<double>>> rest = {};  // (back) and (open), of conductors alone
  std::string zone = {};                                                    // of EnergyPlus

  [[nodiscard]] std::size_t size() const { return patches.size(); }
  [[nodiscard]] double at(std::size_t i, std::size_t j) const { return values[i * size() + j]; }
};
using Texts = std::vector<std::string>;  // of the file, and of those beside it

// Patches keep their order. Values have every digit, but for View3D.
//
// view3d      its output in text (0): areas, rows, emittances (1 - Kd)
// energyplus  an object ZoneProperty:UserViewFactors:bySurfaceName. InputError for a name that it cannot hold
// openfoam    F, globalFaceFaces, finalAgglom and mapDist, of one process, as the radiation model viewFactor reads them
//             from `constant`. A patch of the scene is a patch of the mesh, with one coarse face, and has as many faces
//             as there; patches NAME:1, NAME:2, ... in succession are the coarse faces of one patch
// calculix    *VIEWFACTOR, READ of CalculiX 2.20, in the order of its faces
// moose       CSV of ViewFactorVectorPostprocessor: subdomain_id,vf_to_1,vf_to_2,...
// nek         vf_read_view_factors of Nek5000 and NekRS: for each wall, "iw ieg ifc n", then n times "jw jeg jfc F". A
//             patch named "12:3" is face 3 of element 12; with any other name, all are face 1 of their own number
// esatan      lines GR(1, 2) = 0.25; of a $CONDUCTORS block, of radiosity::Exchange. Zeros are left out
struct ProgramFormat {
  std::string_view name;       // the flag is --NAME
  std::string_view program;    // "OpenFOAM"
  std::string_view extension;  // by which Python knows it; empty: by its name alone
  std::string_view help, lost;
  bool of_conductors = false;
  Texts (*texts)(const Square& square) = nullptr;
};
[[nodiscard]] std::span<const ProgramFormat> program_formats();
inline constexpr std::array<std::string_view, 3> kOpenFoamFiles{"globalFaceFaces", "finalAgglom", "mapDist"};

// What a file of view factors is written from. Throws InputError unless rows and columns are the same patches.
[[nodiscard]] Square square_of(const ProgramFormat& format, const Scene& scene, const Matrix& matrix,
                               std::string zone = "Zone 1");
// The file in `path`, and those beside it.
[[nodiscard]] std::vector<std::pair<std::filesystem::path, std::string>> files_of(const ProgramFormat& format,
                                                                                  const Square& square,
                                                                                  const std::filesystem::path& path);

}  // namespace exactff::matrix
