// The rows of a truth file, and what they depend on.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/truth.h"
#include "jobs/rows.h"
#include "jobs/team.h"
#include "radiosity/gather.h"
#include "truth/columns.h"
#include "whole_view/light.h"

namespace exactff::truth {

// A checked request, with everything precomputed that depends on its sources alone. Threads may share it.
class Rows : public jobs::Rows {
 public:
  // Throws InputError if there is nothing to compute, or if the shard does not exist.
  explicit Rows(Request request);

  [[nodiscard]] const Request& request() const { return request_; }
  [[nodiscard]] std::string name(std::uint64_t row) const override;
  [[nodiscard]] std::unique_ptr<Computer> computer() const override;

  // Objects that a thread reuses from row to row, only to avoid reallocation.
  struct Results {
    FormFactor exact, unoccluded;
    struct Measured {
      FormFactor one;
      std::vector<FormFactor> all;       // of all sources at one receiver,
      std::optional<std::size_t> known;  // this one
    };
    std::array<Measured, 3> measured;  // by measure_column()
    UnitNormal unit_normal;
    whole_view::Light::Results all;       // of all sources at one receiver
    whole_view::Light::Results gathered;  // of all patches, for given radiosities
    whole_view::Channels totals;
    std::optional<std::size_t> known;  // this receiver
    Row row;
  };
  // Computes a row, results.row.
  void compute(std::uint64_t row, Results& results) const;
  [[nodiscard]] const Columns& columns() const { return columns_of_request_; }

 private:
  void describe(const std::vector<std::string>& near_misses);
  [[nodiscard]] std::string id(std::size_t receiver) const;
  [[nodiscard]] ExactOptions options_of_factors() const;
  [[nodiscard]] const FormFactor& factor(std::size_t receiver, std::size_t source, Results& results) const;
  [[nodiscard]] bool has_totals() const { return light_ || gather_; }
  [[nodiscard]] const FormFactor& find_measure(std::size_t receiver, std::size_t source, const Measure& measure,
                                               Results& results) const;
  void find_totals(const Receiver& receiver, const ExactOptions& options, Results& results) const;
  void find_all(std::size_t receiver, const ExactOptions& options, Results& results) const;
  [[nodiscard]] const FormFactor& without_occluders(const Receiver& receiver, std::size_t source,
                                                    const FormFactor& with, Results& results) const;

  Request request_;
  std::vector<Measure> measures_;  // of the request; spheres last, since these need a search of their own
  std::unique_ptr<const whole_view::SourceFactors> sources_;
  std::vector<std::string> source_names_;
  std::vector<Rgb> radiosities_;                     // indexed by source
  std::optional<whole_view::Light> light_;           // for the totals
  std::unique_ptr<const radiosity::Gather> gather_;  // for those of given radiosities
  Columns columns_of_request_;
};

// Counts rows by their status, which is the last field of each row.
class Tally {
 public:
  // Adds text that may begin and end anywhere, even within a row.
  void add(std::string_view text);
  [[nodiscard]] const std::array<std::uint64_t, 4>& by_status() const { return by_status_; }

 private:
  std::array<std::uint64_t, 4> by_status_{};
  std::string open_;  // the beginning of a row, from earlier text
};

// --- By several processes ---

// As write() of exactff/truth.h, by rank 0 of a team. jobs::dismiss() must follow, whatever is thrown. Null: alone.
Summary write(Request request, const std::filesystem::path& file, jobs::Existing existing, const jobs::RowHooks& hooks,
              jobs::Team* team);

// Runs a follower of a team, that is, any other rank. `request` must make the same request as the leader's; what it
// throws is sent to the leader. Only the hooks `cancelled` and slow_seconds are used. Returns the exit code.
int follow(jobs::Team& team, const std::function<Request()>& request, const jobs::RowHooks& hooks);

}  // namespace exactff::truth
