// A small room, and requests for studies of it that take no time, for the tests of the study.
#pragma once

#include "report/report.h"
#include "support/test.h"

namespace exactff::validation {

// A floor, a lamp above it and a plate in between.
inline Scene small_room(bool with_plate) {
  const auto square = [](double half, double z) {
    return std::vector<Vec3>{{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}};
  };
  const std::vector<Vec3> up = square(0.5, 2.0);
  PlainScene plain;
  add(plain, "floor", square(2.0, 0.0), {0.5, 0.25, 0.5}, {});
  add(plain, "lamp", {up.rbegin(), up.rend()}, {1, 1, 1}, {10, 20, 30});
  if (with_plate) add(plain, "plate", square(0.3, 1.0), {0.5, 0.25, 0.5}, {});
  return generate::build(plain);
}

// Of the adaptive algorithm and the exact method only.
inline study::Request small_request(const Scene& scene, int threads) {
  study::Request request;
  request.scene = &scene;
  request.scene_name = "room <&>";
  request.receivers = grid_receivers(scene, scene.select("floor"), {5, 4});
  request.receivers_name = "floor, grid 5x4";
  request.sweeps.eps_b = {0.5, 0.05};
  request.sweeps.rays = {1, 4};
  request.sweeps.seeds = {1, 2};
  request.methods = {.enabled = false, .seeds = 1, .receivers = 6, .budget = 0.005};
  request.threads = threads;
  request.seconds_for_a_time = 0.001;
  return request;
}

// Of every method, a little.
inline study::Request request_with_methods(const Scene& scene, int threads) {
  study::Request request = small_request(scene, threads);
  request.methods = {.enabled = true, .seeds = 3, .receivers = 6, .budget = 0.005};
  return request;
}

// Without a grid there is no profile, which takes much of a small study's time.
inline void scatter(study::Request& request) {
  for (Receiver& receiver : request.receivers) receiver.id = 'r' + receiver.id;
  request.receivers_name = "scattered";
}

// Studies of the room with the plate, run once in each process: of the adaptive algorithm only, and of all methods.
inline const study::Study& small_study() {
  static const Scene scene = small_room(true);
  static const study::Study study = study::run(small_request(scene, 1));
  return study;
}
inline const study::Study& whole_study() {
  static const Scene scene = small_room(true);
  static const study::Study study = study::run(request_with_methods(scene, 1));
  return study;
}

inline std::string text_of(const report::StudyTable& one, const study::Study& study) {
  return table::csv_text(one.make(study));
}

// By file: the tables that hold values.
inline std::map<std::string, std::string> value_tables(const study::Study& study) {
  std::map<std::string, std::string> texts;
  for (const report::StudyTable& table : report::tables()) {
    if (table.file.ends_with("timings.csv") || !table.has_rows(study)) continue;
    texts.emplace(table.file, text_of(table, study));
  }
  return texts;
}

inline void expect_same_values(const study::Study& a, const study::Study& b, std::string_view when) {
  const auto one = value_tables(a), other = value_tables(b);
  EXPECT_EQ(one.size(), other.size()) << when;
  for (const auto& [file, text] : one) EXPECT_TRUE(other.contains(file) && text == other.at(file)) << file << when;
}

}  // namespace exactff::validation

namespace exactff {

using validation::expect_same_values;
using validation::request_with_methods;
using validation::small_request;
using validation::small_room;
using validation::small_study;
using validation::whole_study;

}  // namespace exactff
