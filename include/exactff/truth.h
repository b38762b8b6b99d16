// Truth files: certified form factors of many receivers, one row per receiver and source. Values of other programs are
// compared with them (check.h).
//
// A truth file is a CSV file: a head, which is "# " and one line of JSON with everything that its bytes depend on, one
// line of column names, then the rows, by receiver and for each receiver by source, in order. Its bytes depend on the
// request alone, not on threads, machines, shards, interruptions or resumptions. While the file is being made, finished
// rows are kept in the journal FILE.part beside it, even if the program is killed. FILE itself appears when it is
// complete.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/exact.h"
#include "exactff/exr.h"
#include "exactff/jobs.h"
#include "exactff/radiosity.h"
#include "exactff/receiver.h"
#include "exactff/scene.h"
#include "exactff/view.h"

namespace exactff::truth {

// Rows are distributed in chunks of this size, counted from the first row. A shard consists of whole chunks.
inline constexpr std::uint32_t kChunkRows = 64;

// The rows to compute. Keeps a reference to the scene.
struct Request {
  const Scene* scene = nullptr;
  std::string scene_name;           // name of the scene in the header
  std::vector<Receiver> receivers;  // an empty id is replaced by the receiver's number, from 1
  std::string receivers_name;       // "floor, grid 32x32", or the name of a file
  std::vector<Selection> sources;   // empty: every patch that emits, unless there is `sky`
  // One more source, the last, named "sky": all directions that meet nothing (WholeView::open). Its radiosity is 1.
  bool sky = false;
  // Adds a column: F without any occluder, correctly rounded ("0" is a proved zero, "0.0" an underflow).
  bool unoccluded = false;
  // Adds a column: visible area over whole unclipped area, correctly rounded.
  bool visible_fraction = false;
  // Adds a column for each of these measures (exact.h) other than the form factor: solid_angle, overcast, or sphere,
  // the form factor from a small sphere. Each kind at most once (else InputError).
  std::vector<Measure> measures = {};
  // Adds columns ux,uy,uz: the normal scaled to length 1, each component correctly rounded. The values belong to the
  // exact normal in nx,ny,nz.
  bool unit_normals = false;
  // Adds two columns: u and v of the receiver on its lattice, from 0 to 1. Every receiver must be the cell of a grid.
  bool uv = false;
  // Adds columns dF_dx,dF_dy,dF_dz and dF_dx_status,...: the derivatives by the receiver's point (Gradient::position).
  // At a kink the derivatives are empty and the status is "kink". Not for `sky`.
  bool gradient = false;
  // Adds columns total_r,total_g,total_b: this quantity from all sources together, taken from their balls and rounded
  // once, as an image shows it (render.h). The value is repeated in the rows of all sources of a receiver.
  std::optional<Quantity> total = {};
  // If given, totals are of all patches with these radiosities instead of the sources: the light of all bounces. Adds
  // columns total_lower_r, ..., total_upper_b, which bound the sum over patches, as those of an image do (render.h).
  // Requires `total`, and not that of form factors.
  std::optional<radiosity::Radiosities> radiosities = {};
  KeMeans ke = KeMeans::kRadiosity;  // of the totals
  Engine engine = Engine::kEdges;    // no byte depends on it
  jobs::Shard shard;                 // if not 1/1, the file holds the rows of this shard, for merge()
  int threads = 0;                   // 0: as many as this process may use
};

// A column that a request may add, or several. `name`: of the flag --NAME of `exactff truth`, and in Python.
struct OptionalColumn {
  std::string_view name, help;
  bool Request::*wanted;
};
// All of them. To add one: its member above, its line and its fields in truth/columns.cpp, its value in truth/rows.cpp.
[[nodiscard]] std::span<const OptionalColumn> optional_columns();

struct Summary : jobs::Summary {
  std::array<std::uint64_t, 4> rows_by_status{};  // by Status

  [[nodiscard]] std::uint64_t with(Status status) const { return rows_by_status[static_cast<std::size_t>(status)]; }
};

// Computes the rows and writes the file. Throws InputError if the request, the file or the journal is unusable (a
// journal may be from another request or in use by another process), or if nothing can be written; throws
// Cancelled if the hooks cancel. Whatever is thrown, and even if the process is killed, the rows in the journal
// stay valid: at most a second of work and the current row of each thread are lost.
Summary write(Request request, const std::filesystem::path& file, jobs::Existing existing = jobs::Existing::kRefuse,
              const jobs::RowHooks& hooks = {});

// Computes the rows and writes the same bytes to a stream, each row as soon as those before it are written. Keeps
// nothing, so there is nothing to continue with. Throws InputError if the request is unusable or for a shard, or if the
// stream fails; throws Cancelled if the hooks cancel. Whatever is thrown, the rows in the stream are then incomplete.
Summary write(Request request, std::ostream& out, const jobs::RowHooks& hooks = {});

// Merges all shards of one request into the same bytes as one write() without shards. The order of the shards does not
// matter. Throws one InputError that lists all problems: shards that are missing, duplicate, damaged, unfinished or of
// another request. The file appears complete or not at all.
Summary merge(const std::vector<std::filesystem::path>& shards, const std::filesystem::path& file,
              jobs::Existing existing = jobs::Existing::kRefuse, const jobs::RowHooks& hooks = {});

// Writes the values of a complete truth file as a NumPy array of float64 with a row for each receiver and a column for
// each source, in the order of the file, then three columns for the totals if the file has them: NaN where a value is
// not certified. If the file has gradients, each source has four columns: F, dF/dx, dF/dy, dF/dz, NaN at kinks. The
// array appears complete or not at all, and replaces another file. Throws InputError if a file cannot be read or
// written, and Cancelled.
void write_npy(const std::filesystem::path& truth_file, const std::filesystem::path& file,
               const jobs::RowHooks& hooks = {});

// Writes receivers and values of a complete truth file as NumPy arrays in one file (.npz), in the order of the file:
//
//   points (n, 3)     normals (n, 3): unit vectors, correctly rounded     on (n): index into faces, -1 for none
//   F (n, sources): NaN where a value is not certified                    sources, faces: names; about: the comments
//
// and visible_fraction, unoccluded, solid_angle, overcast and sphere (n, sources), gradient (n, sources, 3): NaN at
// kinks, total (n, 3), if the file has them. numpy.load(file) reads it. The file appears complete or not at all, and
// replaces another one. Throws as write_npy, and if it were larger than 4 GiB.
void write_npz(const std::filesystem::path& truth_file, const std::filesystem::path& file,
               const jobs::RowHooks& hooks = {});

// Writes the values of a complete truth file for ParaView: see vtk::write. `request` is the one that the file was made
// from. Visible fractions and totals are written if the file has them.
void write_vtk(const Request& request, const std::filesystem::path& truth_file, const std::filesystem::path& file,
               const jobs::RowHooks& hooks = {});

// Writes the totals of a complete truth file as an OpenEXR image in the pixels of `frame`, whose receivers the file
// has: channels R, G and B in 32 bits, NaN where there is no certified value, and `mark` (exr::Mark). Throws
// InputError if the file has no totals or other receivers, or cannot be read or written, and Cancelled.
void write_exr(const exr::Frame& frame, const std::filesystem::path& truth_file, const std::filesystem::path& file,
               const jobs::RowHooks& hooks = {});

}  // namespace exactff::truth
