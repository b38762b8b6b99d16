// exactff_bench_tables FILE...: prints the tables of validation/README.md in Markdown, from the JSON output of
// exactff_bench. Uses the median of the repetitions. Exits with 1 if a benchmark failed or the engines differ.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using nlohmann::json;
using Maybe = std::optional<double>;

constexpr std::array kScenes{"sparse", "blinds", "mesh", "dense", "deep", "tiles", "lattice", "near"};
constexpr std::array kSizes{100, 1000, 10'000, 100'000, 1'000'000};

// The measurements, by name.
class Results {
 public:
  void read(const std::string& path) {
    std::ifstream in(path);
    if (!in) throw std::runtime_error("cannot read " + path);
    const json file = json::parse(in);
    for (const json& run : file.at("benchmarks")) add(run);
  }

  // CPU time is the measure that a busy machine affects least.
  [[nodiscard]] Maybe microseconds(const std::string& name) const { return figure(name, "cpu_time"); }
  [[nodiscard]] Maybe figure(const std::string& name, const char* key) const {
    const auto run = runs_.find(name);
    if (run == runs_.end() || !run->second.contains(key)) return {};
    return run->second.at(key).get<double>();
  }
  // False if a benchmark failed, or the engines' values differ.
  [[nodiscard]] bool sound() const;

 private:
  void add(const json& run) {
    // Google Benchmark appends how it ran.
    static const std::regex kAddition("/(iterations:[0-9]+|manual_time|real_time)");
    const std::string name = std::regex_replace(run.at("run_name").get<std::string>(), kAddition, "");
    if (run.value("error_occurred", false)) {
      std::fprintf(stderr, "%s: %s\n", name.c_str(), run.at("error_message").get<std::string>().c_str());
      failed_ = true;
      return;
    }
    if (run.at("time_unit") != "us") throw std::runtime_error(name + " is not in microseconds");
    const bool is_median = run.value("aggregate_name", "") == "median";
    if (is_median || run.at("run_type") == "iteration") runs_[name] = run;
  }

  std::map<std::string, json> runs_;
  bool failed_ = false;
};

std::string at(const std::string& subject, const std::string& scene, int n) {
  return subject + '/' + scene + '/' + std::to_string(n);
}

bool Results::sound() const {
  bool same = true;
  for (const char* scene : kScenes) {
    for (const int n : kSizes) {
      const Maybe edges = figure(at("certified/edges", scene, n), "value");
      const Maybe boolean = figure(at("certified/boolean", scene, n), "value");
      if (!edges || !boolean || *edges == *boolean) continue;
      std::fprintf(stderr, "%s, n = %d: the engines give %.17g and %.17g\n", scene, n, *edges, *boolean);
      same = false;
    }
  }
  return same && !failed_;
}

Maybe operator+(Maybe a, Maybe b) { return a && b ? Maybe(*a + *b) : Maybe(); }
Maybe operator/(Maybe a, Maybe b) { return a && b && *b != 0.0 ? Maybe(*a / *b) : Maybe(); }
Maybe in_ms(Maybe microseconds) { return microseconds / Maybe(1000.0); }

// A whole number or three significant digits; "-" if it was not measured.
std::string text(Maybe value) {
  if (!value) return "-";
  const bool whole = *value == std::round(*value);
  const int digits = whole ? 0 : std::max(0, 2 - static_cast<int>(std::floor(std::log10(std::abs(*value)))));
  std::array<char, 64> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.*f", std::min(digits, 5), *value);
  return buffer.data();
}

void print_row(const std::vector<std::string>& cells) {
  for (const std::string& cell : cells) std::printf("| %s ", cell.c_str());
  std::puts("|");
}

void print_head(const std::string& title, const std::vector<std::string>& columns) {
  std::printf("\n%s\n\n", title.c_str());
  print_row(columns);
  std::string rule = "|---";
  for (std::size_t i = 1; i < columns.size(); ++i) rule += "|--:";
  std::puts((rule + "|").c_str());
}

void print_ratios(const Results& results) {
  constexpr int n = 1000;
  print_head(
      "n = 1000. Engine: the visible edges, with Eq. (4) in double. Limit: Eq. (4) in double over the visible "
      "edges, one after another, every occluder read once. Rays: 10,000 in packets of 16 that end near one "
      "another, told to be coherent or not, whichever is faster. Scattered rays: the same in random order.",
      {"scene", "engine ms", "Boolean ms", "Boolean / engine", "engine / limit", "engine / rays",
       "both with their builds", "engine / scattered rays", "certified ms", "certified / engine"});
  for (const char* scene : kScenes) {
    const auto us = [&](const char* subject) { return results.microseconds(at(subject, scene, n)); };
    const Maybe engine = us("visible/edges"), boolean = us("visible/boolean"), certified = us("certified/edges");
    const Maybe rays =
        std::min(us("rays/coherent"), us("rays/incoherent"));  // a missing value compares as less: no ratio then
    print_row({scene, text(in_ms(engine)), text(in_ms(boolean)), text(boolean / engine), text(engine / us("limit")),
               text(engine / rays), text((engine + us("tree")) / (rays + us("rays/build"))),
               text(engine / us("rays/scattered")), text(in_ms(certified)), text(certified / engine)});
  }
}

// The slope of log time over log n, by least squares, for n within the range.
Maybe fitted_exponent(const std::map<int, double>& time_of, int smallest, int largest) {
  double count = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& [n, time] : time_of) {
    if (n < smallest || n > largest) continue;
    const double log_n = std::log(n), log_time = std::log(time);
    ++count;
    x += log_n;
    y += log_time;
    xx += log_n * log_n;
    xy += log_n * log_time;
  }
  return count < 2 ? Maybe() : Maybe((count * xy - x * y) / (count * xx - x * x));
}

std::string exponents_by_decade(const std::map<int, double>& time_of) {
  std::string list;
  for (const auto& [n, time] : time_of) {
    const auto next = time_of.find(10 * n);
    if (next != time_of.end()) list += (list.empty() ? "" : ", ") + text(std::log10(next->second / time));
  }
  return list.empty() ? "-" : list;
}

void print_growth_of(const Results& results, const std::string& engine, const std::string& scene) {
  std::map<int, double> time_of;
  Maybe undecided, peak;
  std::vector<std::string> cells{engine == "edges" ? scene : scene + ", Boolean"};
  for (const int n : kSizes) {
    const std::string name = at("certified/" + engine, scene, n);
    const Maybe time = results.microseconds(name);
    if (time) time_of[n] = *time;
    cells.push_back(text(in_ms(time)));
    if (const Maybe share = results.figure(name, "undecided_pairs") / results.figure(name, "pairs")) undecided = share;
    if (engine == "edges") {
      if (const Maybe mib = results.figure(at("memory", scene, n), "peak_mib")) peak = mib;
    }
  }
  if (time_of.size() < 2) return;  // one size has no slope
  cells.insert(cells.end(), {exponents_by_decade(time_of), text(fitted_exponent(time_of, 1000, 100'000)),
                             text(undecided), text(peak)});
  print_row(cells);
}

void print_growth(const Results& results) {
  print_head(
      "The certified value, ms. Exponents: per decade, and fitted over 10^3 to 10^5. Undecided: the share "
      "of pairs of an edge and an occluder that the filter left to exact predicates. That and the peak memory (of the "
      "whole process) at the largest n.",
      {"scene", "10^2", "10^3", "10^4", "10^5", "10^6", "per decade", "fitted", "undecided", "peak MiB"});
  for (const char* engine : {"edges", "boolean"}) {
    for (const char* scene : kScenes) print_growth_of(results, engine, scene);
  }
}

void print_contour(const Results& results) {
  print_head("The contour over the visible edges at n = 1000, ns per edge. Arb works on exact terms, made once.",
             {"scene", "edges", "double", "exact terms", "Arb 96 bits", "128 bits", "256 bits"});
  for (const char* scene : kScenes) {
    const Maybe edges = results.figure(at("contour/double", scene, 1000), "edges");
    const auto ns = [&](const char* tier) {
      return text(results.microseconds(at(std::string("contour/") + tier, scene, 1000)) / edges / Maybe(1e-3));
    };
    print_row({scene, text(edges), ns("double"), ns("terms"), ns("arb96"), ns("arb128"), ns("arb256")});
  }
}

void print_cornell(const Results& results) {
  print_head("Cornell box, light to a floor grid of 32 x 32: the certified value, median over receivers.",
             {"receivers", "count", "edges, us", "Boolean, us"});
  for (const std::string kind : {"unoccluded", "partly", "every"}) {
    const std::string edges = "cornell/" + kind + "/edges", boolean = "cornell/" + kind + "/boolean";
    print_row({kind == "partly" ? "partly hidden" : kind, text(results.figure(edges, "receivers")),
               text(results.figure(edges, "real_time")), text(results.figure(boolean, "real_time"))});
  }
  const auto throughput = [&](const char* threads, const char* key) {
    return results.figure(std::string("cornell/throughput/threads:") + threads, key);
  };
  std::printf("\nTwo threads do %s times the work of one (by their CPU time alone, %s times).\n",
              text(throughput("2", "items_per_second") / throughput("1", "items_per_second")).c_str(),
              text(throughput("1", "cpu_time") / throughput("2", "cpu_time") / Maybe(0.5)).c_str());
}

void print_view(const Results& results) {
  print_head("All faces from one point, ms: one by one, in one sweep, and the contour of its arcs alone.",
             {"scene", "faces seen", "arcs", "loop", "sweep", "loop / sweep", "contour"});
  for (const std::string scene : {"karkanis/500", "karkanis/1000", "karkanis/10000", "karkanis/100000", "covered/10000",
                                  "room/400", "room/1600"}) {
    const auto ms = [&](const char* subject) {
      return results.microseconds(std::string("view/") + subject + '/' + scene) / Maybe(1e3);
    };
    const auto figure = [&](const char* key) { return text(results.figure("view/sweep/" + scene, key)); };
    print_row({scene, figure("seen"), figure("arcs"), text(ms("loop")), text(ms("sweep")),
               text(ms("loop") / ms("sweep")), text(ms("contour"))});
  }
}

void print_covers(const Results& results) {
  print_head("All hidden by many together, ms: from scratch, and with what hid the source from a receiver nearby.",
             {"scene", "candidates", "needed", "from scratch", "neighbour"});
  for (const std::string scene : {"deep/100", "deep/1000", "deep/10000", "wall/100", "wall/1000", "wall/10000"}) {
    const auto ms = [&](const char* subject) {
      return text(in_ms(results.microseconds(std::string("covers/") + subject + '/' + scene)));
    };
    const auto figure = [&](const char* key) { return text(results.figure("covers/scratch/" + scene, key)); };
    print_row({scene, figure("candidates"), figure("cover"), ms("scratch"), ms("neighbour")});
  }
}

void print_refinement(const Results& results) {
  print_head(
      "One certified value, the mean over a grid of receivers, as the mesh gets finer. Looked at: edges that the tree "
      "of "
      "edges did not rule out, where silhouettes were searched for. Exponent: of the time, from the row above.",
      {"teapot, triangles", "us", "looked at", "silhouettes", "edges of the visible boundary", "exponent"});
  Maybe time_before, size_before;
  for (const char* segments : {"4", "8", "16", "32", "64"}) {
    const std::string name = std::string("refinement/teapot/") + segments;
    const Maybe time = results.microseconds(name), size = results.figure(name, "triangles");
    if (!time || !size) continue;
    const auto figure = [&](const char* key) { return text(results.figure(name, key)); };
    std::string exponent = "-";
    if (time_before) exponent = text(std::log(*time / *time_before) / std::log(*size / *size_before));
    print_row({figure("triangles"), text(time), figure("looked_at"), figure("silhouettes"), figure("edges"), exponent});
    time_before = time;
    size_before = size;
  }
  print_head("The same scene of polygons, and with every polygon cut into triangles.",
             {"scene", "polygons, us", "triangles, us", "triangles / polygons"});
  for (const std::string scene : {"cornell", "blinds", "closed"}) {
    const Maybe polygons = results.microseconds("refinement/" + scene + "/polygons");
    const Maybe triangles = results.microseconds("refinement/" + scene + "/triangles");
    print_row({scene, text(polygons), text(triangles), text(triangles / polygons)});
  }
}

}  // namespace

int main(int argc, char** argv) try {
  Results results;
  for (int i = 1; i < argc; ++i) results.read(argv[i]);
  print_ratios(results);
  print_growth(results);
  print_contour(results);
  print_cornell(results);
  print_covers(results);
  print_view(results);
  print_refinement(results);
  return results.sound() ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "exactff_bench_tables: %s\n", error.what());
  return 2;
}
