// From a request to its truth file, and from shards; and the values of a finished file in other formats.
#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <ostream>
#include <span>
#include <utility>

#include "exactff/exr.h"
#include "exactff/truth.h"
#include "files/file.h"
#include "files/numpy.h"
#include "files/parallel.h"
#include "jobs/compute.h"
#include "jobs/journal.h"
#include "kernel/float_environment.h"
#include "kernel/vec.h"
#include "table/csv.h"
#include "text/names.h"
#include "text/refuse.h"
#include "truth/columns.h"
#include "truth/rows.h"
#include "vtk/vtk.h"

namespace exactff::truth {
namespace {

namespace fs = std::filesystem;

// The summary, of what `work` does; it gives all rows to the tally.
template <class Work>
Summary counted(const Work& work) {
  Tally tally;
  Summary summary{work([&](std::string_view text) { tally.add(text); }), {}};
  summary.rows_by_status = tally.by_status();
  return summary;
}

}  // namespace

Summary write(Request request, const fs::path& file, jobs::Existing existing, const jobs::RowHooks& hooks,
              jobs::Team* team) {
  const kernel::StandardArithmetic arithmetic;
  const Rows rows(std::move(request));
  files::require_not_read(file, rows.request().scene->files());
  return counted([&](const jobs::See& see) { return jobs::write(rows, file, existing, hooks, team, see); });
}

Summary merge(const std::vector<fs::path>& shards, const fs::path& file, jobs::Existing existing,
              const jobs::RowHooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  return counted([&](const jobs::See& see) { return jobs::merge(shards, file, existing, hooks, see); });
}

Summary write(Request request, const fs::path& file, jobs::Existing existing, const jobs::RowHooks& hooks) {
  return write(std::move(request), file, existing, hooks, nullptr);
}

int follow(jobs::Team& team, const std::function<Request()>& request, const jobs::RowHooks& hooks) {
  return jobs::follow(
      team, [&] { return std::make_unique<Rows>(request()); }, hooks);
}

// --- As a stream ---

// No journal, no shard. Threads finish pieces of chunks in any order; the calling thread writes them in order.

namespace {

constexpr auto kBetweenWrites = std::chrono::milliseconds(20);

class Stream {
 public:
  Stream(const Rows& rows, std::ostream& out, const jobs::RowHooks& hooks)
      : rows_(rows), out_(out), hooks_(hooks), schedule_(rows, {}) {}

  void run(Summary& summary) {
    put(rows_.head());
    files::WorkerPool pool(rows_.plan().threads, {{}, hooks_.cancelled}, [this](files::WorkerPool::Worker& worker) {
      jobs::compute_rows(
          rows_, hooks_.slow_seconds, [this] { return schedule_.next(); },
          [this](jobs::Finished finished) { keep(std::move(finished)); }, worker);
    });
    for (bool ended = false; !ended;) {
      ended = pool.wait_for(kBetweenWrites);
      write_what_is_next(summary, pool.slow_step(files::kSlowStep));
    }
    pool.rethrow();
    summary.rows_by_status = tally_.by_status();
  }

 private:
  void keep(jobs::Finished finished) {
    const std::lock_guard lock(mutex_);
    done_ += finished.range.rows;
    waiting_.emplace(finished.range.first, std::move(finished));
  }

  void write_what_is_next(Summary& summary, std::optional<std::uint64_t> slow_row) {
    std::map<std::uint64_t, jobs::Finished> ready;
    std::uint64_t done = 0;
    {
      const std::lock_guard lock(mutex_);
      while (!waiting_.empty() && waiting_.begin()->first == next_) {
        next_ = waiting_.begin()->second.range.end();
        ready.insert(waiting_.extract(waiting_.begin()));
      }
      done = done_;
    }
    for (const auto& [first, finished] : ready) {
      put(finished.lines);
      tally_.add(finished.lines);
      tell_slow(finished, summary);
    }
    out_.flush();
    require_written();
    if (!hooks_.progress) return;
    const std::string slow = slow_row ? rows_.name(*slow_row) : std::string();
    hooks_.progress({"rows", done, rows_.count(), slow});
  }

  void tell_slow(const jobs::Finished& finished, Summary& summary) {
    summary.slow += finished.slow.size();
    for (const jobs::SlowRow& slow : finished.slow) {
      if (hooks_.slow_row) hooks_.slow_row(rows_.name(slow.row), slow.seconds);
    }
  }

  void put(const std::string& text) {
    out_.write(text.data(), static_cast<std::streamsize>(text.size()));
    require_written();
  }

  void require_written() {
    if (out_) return;
    text::refuse("the rows could not be written", "the output is incomplete",
                 "free some disk space, or send the output elsewhere");
  }

  const Rows& rows_;
  std::ostream& out_;
  const jobs::RowHooks& hooks_;
  jobs::Schedule schedule_;
  std::mutex mutex_;
  std::map<std::uint64_t, jobs::Finished> waiting_;  // by first row
  std::uint64_t next_ = 0;
  std::uint64_t done_ = 0;
  Tally tally_;
};

}  // namespace

Summary write(Request request, std::ostream& out, const jobs::RowHooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  const Rows rows(std::move(request));
  if (rows.request().shard.count > 1) {
    text::refuse("a shard cannot be written to a stream", "shards are files that exactff merge reads",
                 "name a file, or compute all rows");
  }
  Summary summary;
  summary.rows = rows.count();
  const auto start = std::chrono::steady_clock::now();
  Stream(rows, out, hooks).run(summary);
  summary.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return summary;
}

// --- Other formats ---

// The values of a finished truth file in other formats. They are read from the file itself, so they are the same
// whether its rows were computed at once, resumed, merged, or computed by several processes.

namespace {

constexpr std::size_t kRowsBetweenChecks = 256;  // whether the user has cancelled

table::RowReader<Row> reader_of(const fs::path& file) {
  return {file, all_columns(), "name a file that exactff truth or merge has written"};
}

// What a truth file holds: every receiver with all sources, in their order.
class Reading {
 public:
  // Throws InputError unless it is a whole truth file; and Cancelled.
  Reading(const fs::path& file, const jobs::RowHooks& hooks) : file_(file), hooks_(hooks), reader_(reader_of(file)) {
    sources_ = reader_.head().head.list("sources");
    const jobs::RowHooks silent{.cancelled = hooks.cancelled};  // the number of rows is not known yet
    jobs::Pace pace("reading rows", 0, silent);
    table::RowReader<Row> counter = reader_of(file);
    for (Row row; counter.next(row); ++rows_) {
      const bool no_normal = counter.has("nx") && (!kernel::is_finite(row.normal) || row.normal == Vec3{});
      if (sources_.empty() || row.source != sources_[rows_ % sources_.size()] || no_normal) {
        counter.damaged();
      }
      if (rows_ % kRowsBetweenChecks == 0) pace.add(0);
    }
    if (rows_ == 0 || rows_ % sources_.size() != 0) counter.damaged();
  }

  [[nodiscard]] const std::vector<std::string>& sources() const { return sources_; }
  [[nodiscard]] std::size_t rows() const { return rows_; }
  [[nodiscard]] std::size_t receivers() const { return rows_ / sources_.size(); }
  [[nodiscard]] bool has(std::string_view column) const { return reader_.has(column); }
  [[nodiscard]] std::vector<std::string> about() const { return table::lines_of(reader_.head()); }

  // Calls take(receiver, source, row) for every row.
  void for_each(const char* stage, const std::function<void(std::size_t, std::size_t, const Row&)>& take) {
    jobs::Pace pace(stage, rows_, hooks_);
    Row row;
    for (std::size_t i = 0; i < rows_ && reader_.next(row); ++i) {
      take(i / sources_.size(), i % sources_.size(), row);
      if ((i + 1) % kRowsBetweenChecks == 0) pace.add(kRowsBetweenChecks);
    }
    pace.add(0);
  }

  void require_receivers(std::size_t count) const {
    if (receivers() == count) return;
    text::refuse(file_, "has values of other receivers", "each place shows the values of its receiver",
                 "use the flags with which the file was made");
  }

 private:
  fs::path file_;
  const jobs::RowHooks& hooks_;
  table::RowReader<Row> reader_;
  std::vector<std::string> sources_;
  std::size_t rows_ = 0;
};

std::array<double, 3> three(const Vec3& v) { return {v.x, v.y, v.z}; }
std::array<double, 3> certified(const Row& row, const Rgb& c) {
  return {row.certified(c.r), row.certified(c.g), row.certified(c.b)};
}

}  // namespace

void write_npy(const fs::path& truth_file, const fs::path& file, const jobs::RowHooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  Reading rows(truth_file, hooks);
  const std::size_t sources = rows.sources().size();
  const bool gradients = rows.has("dF_dx"), totals = rows.has("total_r");
  const std::array extents{rows.receivers(), (gradients ? 4 : 1) * sources + (totals ? 3 : 0)};
  files::NpyFile<double> array(file, extents);
  rows.for_each("writing the NumPy file", [&](std::size_t, std::size_t source, const Row& row) {
    array.append(row.certified(row.exact));
    if (gradients) array.append(three(row.gradient));
    if (totals && source + 1 == sources) array.append(certified(row, row.total));
  });
  array.commit();
}

void write_npz(const fs::path& truth_file, const fs::path& file, const jobs::RowHooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  Reading rows(truth_file, hooks);
  const bool gradients = rows.has("dF_dx"), totals = rows.has("total_r"), fractions = rows.has("visible_fraction"),
             unoccluded = rows.has("unoccluded");
  const auto append = [](std::vector<double>& list, const std::array<double, 3>& numbers) {
    list.insert(list.end(), numbers.begin(), numbers.end());
  };
  std::vector<double> points, normals, total, factor, fraction, free, gradient;
  std::vector<std::int32_t> on;
  static constexpr std::array kMeasures = {"solid_angle", "overcast", "sphere"};  // by measure_column()
  std::array<std::vector<double>, 3> measured;
  constexpr std::int32_t kNoFace = -1;
  text::NameList faces;  // in the order of their first use
  UnitNormal unit_normal;
  rows.for_each("reading rows", [&](std::size_t, std::size_t source, const Row& row) {
    if (source == 0) {
      append(points, three(row.point));
      append(normals, three(unit_normal.of(row.normal)));
      on.push_back(row.on.empty() ? kNoFace : static_cast<std::int32_t>(faces.number_of(row.on)));
      if (totals) append(total, certified(row, row.total));
    }
    factor.push_back(row.certified(row.exact));
    if (fractions) fraction.push_back(row.certified(row.visible_fraction));
    if (unoccluded) free.push_back(row.certified(row.unoccluded));
    for (std::size_t m = 0; m < measured.size(); ++m) {
      if (rows.has(kMeasures[m])) measured[m].push_back(row.certified(row.measures[m]));
    }
    if (gradients) append(gradient, three(row.gradient));
  });
  files::NpzFile archive(file);
  const auto add = [&](const char* name, const std::vector<double>& numbers, std::size_t columns) {
    const std::array shape{rows.receivers(), columns};
    if (!numbers.empty()) archive.add(name, shape, std::span<const double>(numbers));
  };
  const std::size_t sources = rows.sources().size();
  add("points", points, 3);
  add("normals", normals, 3);
  archive.add("on", on);
  archive.add_texts("faces", faces.take());
  archive.add_texts("sources", rows.sources());
  add("F", factor, sources);
  add("visible_fraction", fraction, sources);
  if (gradients) {
    archive.add("gradient", std::array{rows.receivers(), sources, std::size_t{3}}, std::span<const double>(gradient));
  }
  add("unoccluded", free, sources);
  for (std::size_t m = 0; m < measured.size(); ++m) add(kMeasures[m], measured[m], sources);
  add("total", total, 3);
  archive.add_texts("about", rows.about());
  archive.commit();
}

void write_vtk(const Request& request, const fs::path& truth_file, const fs::path& file, const jobs::RowHooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  Reading rows(truth_file, hooks);
  rows.require_receivers(request.receivers.size());
  const bool gradients = rows.has("dF_dx"), totals = rows.has("total_r"), fractions = rows.has("visible_fraction");
  std::vector<vtk::SourceValues> list;
  for (const std::string& source : rows.sources()) list.push_back({source, {}, {}, {}, {}, {}, {}, {}});
  std::vector<double> total;
  rows.for_each("reading rows", [&](std::size_t, std::size_t source, const Row& row) {
    vtk::SourceValues& values = list[source];
    values.exact.push_back(row.exact);
    values.lower.push_back(row.lower);
    values.upper.push_back(row.upper);
    values.status.push_back(static_cast<std::uint8_t>(row.status));
    if (gradients) values.gradient.push_back(row.gradient);
    if (fractions) values.visible_fraction.push_back(row.visible_fraction);
    values.radiosity.push_back(row.radiosity);
    if (totals && source == 0) total.insert(total.end(), {row.total.r, row.total.g, row.total.b});
  });
  std::vector<vtk::Field> fields = vtk::fields_of(std::move(list));
  if (totals) fields.push_back({"total", 3, std::move(total)});
  const vtk::Content content{
      .scene = request.scene, .receivers = request.receivers, .fields = std::move(fields), .about = rows.about()};
  vtk::write(content, file, {{}, hooks.cancelled});
}

void write_exr(const exr::Frame& frame, const fs::path& truth_file, const fs::path& file, const jobs::RowHooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  Reading rows(truth_file, hooks);
  rows.require_receivers(frame.pixels.size());
  if (!rows.has("total_r")) {
    text::refuse(truth_file, "has no totals", "a pixel shows the light of all sources together",
                 "compute it again with --total radiance and --force");
  }
  exr::FrameValues values(frame);
  rows.for_each("writing the image", [&](std::size_t receiver, std::size_t source, const Row& row) {
    if (source == 0) values.set(receiver, row.total, row.status != Status::kNotCertified);
  });
  files::WholeFile whole(file);
  whole.append(values.exr(rows.about()));
  whole.commit();
}

}  // namespace exactff::truth
