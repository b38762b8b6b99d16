// The rows of a truth file, and the head above them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/truth.h"
#include "jobs/rows.h"
#include "radiosity/gather.h"
#include "truth/unit_normal.h"
#include "whole_view/light.h"

namespace exactff::truth {

inline constexpr jobs::RowKind kKind = {"truth", "a truth file", "row", "rows"};

// A checked request, with everything precomputed that depends on its sources alone. Threads may share it.
class Rows : public jobs::Rows {
 public:
  // Throws InputError if there is nothing to compute, or if the shard does not exist.
  explicit Rows(Request request);

  [[nodiscard]] const Request& request() const { return request_; }
  [[nodiscard]] std::string head() const override;
  [[nodiscard]] std::string name(std::uint64_t row) const override;
  [[nodiscard]] bool may_be_text_of(jobs::Range range, std::string_view text) const override;
  [[nodiscard]] std::unique_ptr<Computer> computer() const override;

  // Objects that a thread reuses from row to row, only to avoid reallocation.
  struct Results {
    FormFactor exact, unoccluded;
    UnitNormal unit_normal;
    whole_view::Light::Results all;       // of all sources at one receiver
    whole_view::Light::Results gathered;  // of all patches, for given radiosities
    whole_view::Channels totals;
    std::optional<std::size_t> known;  // this receiver
  };
  // Computes a row and appends its line.
  void append(std::uint64_t row, std::string& lines, Results& results) const;

 private:
  [[nodiscard]] std::string id(std::size_t receiver) const;
  [[nodiscard]] const FormFactor& factor(std::size_t receiver, std::size_t source, Results& results) const;
  [[nodiscard]] bool has_totals() const { return light_ || gather_; }
  void find_totals(const Receiver& receiver, const ExactOptions& options, Results& results) const;
  void find_all(std::size_t receiver, const ExactOptions& options, Results& results) const;
  [[nodiscard]] const FormFactor& without_occluders(const Receiver& receiver, std::size_t source,
                                                    const FormFactor& with, Results& results) const;

  Request request_;
  std::unique_ptr<const whole_view::SourceFactors> sources_;
  std::vector<std::string> source_names_;
  std::vector<Rgb> radiosities_;                     // indexed by source
  std::optional<whole_view::Light> light_;           // for the totals
  std::unique_ptr<const radiosity::Gather> gather_;  // for those of given radiosities
  std::string receivers_hash_;
  std::vector<std::string> near_misses_;  // in sentences
};

// Counts rows by their status, which is the last field of each row.
class Tally {
 public:
  // Adds text that may begin and end anywhere, even within a row.
  void add(std::string_view text);
  // The same for whole rows. Returns false unless there are exactly `expected` of them.
  bool add_rows(std::string_view text, std::uint64_t expected);

  [[nodiscard]] std::uint64_t rows() const;
  // Whether the text so far consists of whole rows of a truth file only.
  [[nodiscard]] bool whole() const { return sound_ && !row_open_; }
  [[nodiscard]] const std::array<std::uint64_t, 4>& by_status() const { return by_status_; }

 private:
  void end_row(std::string_view status);

  std::array<std::uint64_t, 4> by_status_{};
  std::string field_;  // the beginning of the last field, from earlier text
  bool quoted_ = false;
  bool row_open_ = false;
  bool sound_ = true;
};

}  // namespace exactff::truth
