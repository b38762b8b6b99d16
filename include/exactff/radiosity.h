// Radiosity: the light that leaves each patch after all its bounces, with bounds.
//
//   B_i = E_i + rho_i sum_j F_ij B_j
//
// E is Ke, rho is Kd, F is the matrix of view factors, one equation for each colour channel. Each patch has one
// radiosity: B is the exact solution of this system, not of the integral equation, which lets radiosity vary over a
// patch. Divide a patch into several where that matters. Where the system has several solutions that are not negative,
// B is the smallest: the sum E + rho F E + (rho F)^2 E + ... over the bounces.
//
// Of F, only bounds are known: L <= F <= U. B lies between two vectors that are checked to be a sub- and a
// supersolution of every such system, with every rounding outward (src/products/radiosity/system.h has the proof). So
// its bounds are as strong as the weakest claim of the view factors.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/jobs.h"
#include "exactff/matrix.h"
#include "exactff/scene.h"
#include "exactff/view_factors.h"

namespace exactff::radiosity {

// In the unit of Ke. `value` is an estimate, NaN if the solver finds none; [lower, upper] holds the true number.
struct BoundedValue {
  double value = 0.0;
  double lower = 0.0;
  double upper = 0.0;
};

// Where the light goes, in the unit of Ke times area: bounds of sums over all patches and bounces.
//   emitted = absorbed + what meets backs of faces (back) + what meets nothing (open)
// `lost` is back and open together. Where the matrix does not have these two, `lost` is what the view factors of each
// row leave of 1, and each of the two is at most that: 0 where no point of a patch is before the back of a face, or
// where a closed surface stands around all that it sees, and then the other is all that is lost.
//
// The bounds of the sums are clipped by what is proved (src/products/radiosity/balance.h), however wide the view
// factors are. None of them is below 0, and while `reasons_against_balance` is empty none of the three is above what is
// emitted. But if some Kd is above 1, `absorbed` may be negative and light may be gained: then only sums that are
// bounded have upper bounds. Where B is infinite, light that bounces for ever is in none of the three.
struct Balance {
  matrix::Sum emitted, absorbed, back, open, lost;
};

struct Channel {
  std::vector<BoundedValue> radiosity;   // B, for each patch
  std::vector<BoundedValue> irradiance;  // sum_j F_ij B_j, for each patch: the mean over its part that is not buried
  std::vector<double> variation;         // for each patch, by set_variation(); NaN where there is no value
  Balance balance;
  bool is_balanced = true;  // as is_balanced() below, of this channel
  // Why there is no upper bound: "Kd is 1 on floor and lamp, ...". Empty: there is one. Without it, upper bounds are
  // infinite, and lower bounds are E_i and 0, which hold all the same.
  std::string no_bound;
  std::string remedy;  // what would give a bound

  [[nodiscard]] bool is_bounded() const { return no_bound.empty(); }
};

inline constexpr std::string_view kNoBound = "no bound";  // in place of a claim
inline constexpr std::array<std::string_view, 3> kChannelNames = {"red", "green", "blue"};

struct Solution {
  std::vector<Selection> patches;
  std::vector<double> areas;        // of the parts not buried (scene.h), in the square of the scene's unit of length
  std::array<Channel, 3> channels;  // of Kd and Ke
  Claim claim = Claim::kZero;       // the weakest of all view factors between patches
  Claim claim_of_balance = Claim::kZero;
  // Why the two sides of the balance need not agree: "some faces are transparent". Empty: they agree.
  std::vector<std::string> reasons_against_balance;
  bool lost_is_rest = false;       // back or open are not computed, so that the balance tests less: no row is above 1
  std::size_t wide = 0;            // view factors between patches that are wider than the accuracy asked for
  std::optional<double> width;     // as asked for in Options
  std::size_t computed_again = 0;  // view factors, for this width

  [[nodiscard]] bool is_bounded() const {
    return channels[0].is_bounded() && channels[1].is_bounded() && channels[2].is_bounded();
  }
};

// Every patch with area, in the order of the file. Throws InputError that names the patches whose faces differ in Kd or
// Ke.
[[nodiscard]] std::vector<Selection> patches_of(const Scene& scene);

struct Options {
  ViewFactorOptions factors = {};
  // upper - lower is wanted to be at most this share of the brightest radiosity of the channel, for every patch. View
  // factors are first computed with the accuracy in `factors`, which may be coarse: accuracy_for(width). Those that
  // widen bounds too much are computed again, with half of it, or a quarter, an eighth, ... (narrowing.h), within the
  // same budget; each is then as view_factor gives it alone with that accuracy. Nothing: the accuracy alone decides.
  std::optional<double> width = {};
  bool backs = false;  // also compute what meets backs, so that the balance tells it from what is open
  int threads = 0;     // 0: all; does not affect the result
};

// Of view factors, to begin with: few entries have to be more accurate.
[[nodiscard]] double accuracy_for(double width);

// What solve() needs to know, for matrix::compute. Throws InputError for a width that is not positive and finite.
[[nodiscard]] matrix::Options matrix_options(const Options& options);

// Requires the factors between all of patches_of(scene), as rows and as columns. If the matrix has `back` or `open`,
// the balance uses them. Throws std::invalid_argument otherwise, and what patches_of throws.
[[nodiscard]] Solution solve(const Scene& scene, const matrix::Matrix& matrix);

// Computes the view factors first. Throws what matrix_options, matrix::compute and patches_of throw.
[[nodiscard]] Solution solve(const Scene& scene, const Options& options = {}, const Hooks& hooks = {});

// The widest bounds of a radiosity, as a share of the brightest one of its channel (its lower bound).
struct Widest {
  std::size_t patch = 0, channel = 0;
  double share = 0.0;  // infinite where there is no upper bound
};
[[nodiscard]] Widest widest_bounds(const Solution& solution);

// Whether the bounds of both sides of the balance of every channel that is bounded have a number in common. If they do
// not, although `reasons_against_balance` is empty, some bound does not hold.
[[nodiscard]] bool is_balanced(const Solution& solution);

// How much the true radiosity varies over each patch, where the solution has one number: sets Channel::variation to the
// largest distance of B(x) = Ke + Kd sum_j F(x, j) B_j from B_i, at the centre of each convex part of the patch and
// near its corners, an eighth of the way to the centre. F is exact, B the values of the solution. Where it is large
// beside B_i, the patch should be divided. An estimate: nothing is known of points in between.
void set_variation(const Scene& scene, Solution& solution, int threads = 0, const Hooks& hooks = {});

// --- Exchange factors ---

// Gebhart's factors B_ij: of what patch i emits, the share that patch j absorbs after all bounces, if patches are gray
// and diffuse with emissivity eps = 1 - Kd in each channel. Backs of faces and what is open are black.
//
//   B_ij = F_ij eps_j + sum_k F_ik rho_k B_kj
//
// B_ij grows with every F, so it lies between its values for the bounds of F; these follow from the inequalities of
// radiosity/system.h, for one column after another: where only j emits 1, eps_j times the irradiance of i is B_ij.
struct Exchange {
  struct Channel {
    std::vector<BoundedValue> factors;     // B_ij, row by row
    std::vector<BoundedValue> back, open;  // of each row, to the black rest; empty if the matrix does not have them
    // GR_ij = eps_i A_i B_ij, in the square of the scene's unit of length. Symmetric to the bit. Heat flows from i to j
    // by sigma GR_ij (T_i^4 - T_j^4), and from i into the black rest of temperature T by sigma GR (T_i^4 - T^4).
    std::vector<BoundedValue> conductors;
    std::vector<BoundedValue> conductors_to_back, conductors_to_open;
    std::vector<double> emissivities;  // 1 - Kd
    std::string no_bound, remedy;      // as in Channel above
    [[nodiscard]] bool is_bounded() const { return no_bound.empty(); }
  };
  std::vector<Selection> patches;
  std::vector<double> areas;      // as in Solution
  std::vector<Channel> channels;  // red, green and blue; one if they have the same Kd everywhere
  Claim claim = Claim::kZero;     // of the bounds: the weakest of the matrix
};

// Requires the factors between all of patches_of(scene). Values are estimates, by the values of the matrix, to about
// 1e-14: if these are balanced (matrix::with_values), values of a row add up to 1 with back and open. Threads do not
// affect the result. Throws InputError for a matrix of other patches, for a Kd above 1, and what patches_of throws.
[[nodiscard]] Exchange exchange(const Scene& scene, const matrix::Matrix& matrix, int threads = 0,
                                const Hooks& hooks = {});

// What exchange() refuses, and square_of() where a format is given, as far as the scene tells.
void require_exchangeable(const Scene& scene, const matrix::ProgramFormat* format = nullptr);

// A row for each pair and channel:
// from,to,channel,exchange,lower,upper,conductor,conductor_lower,conductor_upper,claim. `to` may be (back) or (open);
// with one channel, it is called `all`. What is infinite or not known is empty.
[[nodiscard]] table::Table table_of(const Scene& scene, const Exchange& exchange, const ViewFactorOptions& options);

// What a file of conductors is written from (matrix::ProgramFormat), with a node for backs and one for what is open, if
// the matrix has them. Throws InputError unless the three channels are alike and have values.
[[nodiscard]] matrix::Square square_of(const matrix::ProgramFormat& format, const Scene& scene,
                                       const Exchange& exchange);

// --- Temperatures ---

inline constexpr double kStefanBoltzmann = 5.670374419e-8;  // sigma, W / (m^2 K^4)

// What is known of a surface: its temperature in K, or the heat in W that it gives off, net. Lengths are in
// the scene's unit, or in metres if it has none.
struct Known {
  std::optional<double> temperature = {}, heat = {};
};
struct ThermalConditions {
  std::vector<Known> patches;     // of patches_of(scene), one of the two each
  double back = 0.0, open = 0.0;  // temperatures, in K, of the black backs of faces and of what is open
};
// A name means what flags mean by it; the heat of several patches is shared by their areas. (back) and (open) may have
// a temperature, which is else 0. Throws one InputError for every problem, also for patches without a condition.
struct Condition {
  std::string name;
  Known known = {};
};
[[nodiscard]] ThermalConditions conditions_of(const Scene& scene, std::span<const Condition> all);
// The same from a CSV file with the columns patch, T, Q, in any order, one of T and Q in each row. Problems have
// file:line.
[[nodiscard]] ThermalConditions read_conditions(const Scene& scene, const std::filesystem::path& file);

// Gray diffuse surfaces with emissivity 1 - Kd that exchange sigma T^4. With J what leaves and H what arrives, per
// area:
//   J = eps sigma T^4 + rho H where T is known;   J = H + Q / A where Q is, and then sigma T^4 = H + Q / (A eps).
// This is the system of radiosities with rho = 1 where Q is known, so J, H, and all that follows from them have bounds.
struct Temperatures {
  std::vector<Selection> patches;
  std::vector<double> areas, emissivities;  // areas in m^2
  std::vector<BoundedValue> temperatures;   // in K; both ends are what was given, where it was
  std::vector<BoundedValue> heats;          // in W, net, given off
  BoundedValue to_back, to_open;            // heat that goes there, net; 0 where all rows prove that nothing does
  BoundedValue unbalanced;       // the sum of all heats less these two; its bounds hold 0 where rows add up to 1
  Claim claim = Claim::kZero;    // of the bounds
  std::string no_bound, remedy;  // as in Channel
  [[nodiscard]] bool is_bounded() const { return no_bound.empty(); }
};

// Requires the factors between all of patches_of(scene), with `back` and `open`. Throws InputError for other matrices;
// for a patch whose Kd differs between channels or is above 1, or is 1 where Q is known and not 0 or T is wanted; and
// where more heat is taken away than can arrive.
[[nodiscard]] Temperatures temperatures(const Scene& scene, const matrix::Matrix& matrix,
                                        const ThermalConditions& conditions);

// A row for each patch, (back) and (open): patch,temperature,temperature_lower,temperature_upper,heat,heat_lower,
// heat_upper,emissivity,area,claim.
[[nodiscard]] table::Table table_of(const Scene& scene, const Temperatures& found, const ViewFactorOptions& options);

// The claim of a channel: that of the solution, or "no bound".
[[nodiscard]] std::string_view claim_text(const Solution& solution, const Channel& channel);

// --- Files ---

// How the scene was made from its file, where flags do not say so again.
struct Origin {
  std::optional<double> divided = {};       // by this length (scene.h)
  std::vector<std::string> two_sided = {};  // of matrix::with_two_sided: names, each as a flag had it
};

// A row for each patch and channel: patch,channel,radiosity,lower,upper,irradiance,irradiance_lower,irradiance_upper,
// claim,area, and variation if it is set. What is infinite or not known is empty, and the claim is then "no bound". The
// head states the scene's hash, the origin, what was asked for, and how many view factors are wider.
[[nodiscard]] table::Table table_of(const Scene& scene, const Solution& solution, const ViewFactorOptions& options,
                                    const Origin& origin = {});

// What such a table holds.
struct SolutionFile {
  struct Row {
    std::string patch;
    std::size_t channel = 0;  // of kChannelNames
    BoundedValue radiosity;   // upper infinite: no bound
    BoundedValue irradiance;
    double area = 0.0;
    double variation = 0.0;           // NaN: there is none
    std::optional<Claim> claim = {};  // nothing: no bound
  };
  std::string file;
  std::string scene_hash;
  Origin origin = {};
  ViewFactorOptions options = {};  // as asked for
  std::size_t wide = 0;            // as in Solution
  std::optional<double> width = {};
  Claim claim = Claim::kZero;  // the weakest of all rows with bounds
  std::vector<Row> rows = {};
};
// In any format. Throws one InputError with file:line for every problem.
[[nodiscard]] SolutionFile read_solution(const std::filesystem::path& file);

// Writes the radiosities, their bounds and the irradiances for ParaView (.vtp, .vtu), at the faces of the patches,
// three channels each, NaN elsewhere. Throws InputError if the file cannot be written.
void write_vtk(const Scene& scene, const Solution& solution, const std::filesystem::path& file);

// What table_of was given, but for what no row has: the balance, claim_of_balance, and why there is no bound. Throws
// InputError if the file is of another scene, by its hash and names.
[[nodiscard]] Solution solution_of(const Scene& scene, const SolutionFile& file);

// --- Gathering ---

// What leaves all patches of a scene, for the light at its points: render.h, truth.h. Finite, not negative.
struct Radiosities {
  std::string name = {};       // of the solution, in metadata
  Claim claim = Claim::kZero;  // how strong the bounds are
  std::vector<Selection> patches = {};
  std::vector<Rgb> value = {}, lower = {}, upper = {};  // for each patch
};
// Throw InputError if a channel has no bound; that of a file, if it is of another scene, by its hash and names.
[[nodiscard]] Radiosities radiosities_of(const Solution& solution);
[[nodiscard]] Radiosities radiosities_of(const Scene& scene, const SolutionFile& file);

}  // namespace exactff::radiosity
