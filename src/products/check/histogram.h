// Histograms of errors on a logarithmic axis.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "exactff/check.h"

namespace exactff::check {

// Of the magnitudes of the errors. The bins within a decade have equal width on a logarithmic axis.
struct HistogramBin {
  double low = 0.0;  // exclusive, except in the first bin, which also holds everything below it
  double high = 0.0;
  std::size_t count = 0;
};
struct Histogram {
  std::size_t exact = 0;  // number of errors equal to 0
  std::vector<HistogramBin> bins;
};
[[nodiscard]] Histogram histogram(const Report& report, int bins_per_decade = 1, std::size_t most_bins = 24);

// A gnuplot script that plots the histogram as SVG to standard output; empty if every error is 0.
[[nodiscard]] std::string histogram_script(const Report& report);

// The picture that gnuplot makes of this script, or the reason why there is none. Throws InputError if there is no
// place for temporary files. Ends gnuplot if `cancelled` returns true while it runs.
struct Plot {
  std::string svg;
  std::string why_not;  // empty if there is a picture
};
[[nodiscard]] Plot plot_histogram(const Report& report, const std::function<bool()>& cancelled = {});

}  // namespace exactff::check
