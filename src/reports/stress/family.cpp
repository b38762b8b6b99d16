#include "stress/family.h"

#include <cmath>
#include <iterator>
#include <string>

namespace exactff::stress {

namespace {

double power_of_ten(int exponent) { return std::stod("1e" + std::to_string(exponent)); }

std::vector<Family> make_all() {
  std::vector<Family> all;
  for (auto* group : {distance_families, occluder_families, crowd_families, number_families}) {
    std::vector<Family> some = group();
    all.insert(all.end(), std::make_move_iterator(some.begin()), std::make_move_iterator(some.end()));
  }
  return all;
}

}  // namespace

const std::vector<Family>& all_families() {
  static const std::vector<Family> all = make_all();
  return all;
}

std::vector<double> decades(int last) {
  constexpr int kEveryOneTo = 16, kStep = 20;
  std::vector<double> list;
  for (int e = 0; e < last; e += e < kEveryOneTo ? 1 : kStep) list.push_back(power_of_ten(e));
  list.push_back(power_of_ten(last));
  return list;
}

std::vector<double> octaves(int last, int step) {
  std::vector<double> list;
  for (int e = 0; e <= last; e += step) list.push_back(std::ldexp(1.0, e));
  return list;
}

}  // namespace exactff::stress
