// Splits the directions around x into windows in which few faces are seen.
//
// A window is a cell of one of the six faces of a cube around x, whose axes are those of the space: the directions
// (s, u, v), (v, s, u) or (u, v, s), s = +-1, with u and v in two intervals within [-1, 1]. It is the convex cone of
// its four corners, whose coordinates are exact. A window starts as a cube's face and is split into four until few
// edges of outlines cross it.
//
// An outline stays in a window unless it is proved to be outside (all four corners of the window certainly outside one
// of its lines, or its bounds in the cell's coordinates certainly beyond the cell) or hidden there: by an outline that
// covers the whole window and is certainly nearer in its four corners, and so, w being linear (see below), in all its
// directions.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <span>
#include <utility>
#include <vector>

#include "visibility/outlines.h"

namespace exactff::whole_view {

// --- Depths ---

// Which of two faces is nearer to x in a direction.
//
// The plane N . (y - x) = c, c > 0, lies at y = x + d / w in direction d, where w = (N / c) . d is its inverse depth.
// Of two faces that are both seen in direction d, the one with the larger w is nearer. w is linear in d, so two signs
// decide for all directions between two given ones, and the directions in which two planes are equally deep form one
// plane through x.

using kernel::InverseDepth;
using visibility::CornerId;
using visibility::EdgeId;
using visibility::OutlineId;
using visibility::Outlines;

class Depths {
 public:
  // Forgets all outlines.
  void start(const Scene& scene, const Vec3& x, int scale_exponent);
  // The next outline lies in the plane of this piece. Requires that the plane does not hold x; this
  // is checked where the exact plane is needed.
  void add(const Piece& piece);
  [[nodiscard]] std::span<const InverseDepth> all() const { return depths_; }
  [[nodiscard]] const InverseDepth& of(OutlineId outline) const { return depths_[outline]; }
  [[nodiscard]] const Piece& piece(OutlineId outline) const { return *pieces_[outline]; }

  // +1, 0, -1: the plane of p is nearer than, as far as, further than the plane of q in the direction of the corner.
  // Both planes must be ahead in some direction near the corner, or be compared by their linear w alone.
  [[nodiscard]] int compare(Outlines& outlines, OutlineId p, OutlineId q, CornerId corner);
  // The exact normal of an outline's plane, turned away from x.
  [[nodiscard]] const kernel::ExactVec3& exact_normal(OutlineId outline) { return exact(outline).normal; }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  struct Exact {
    kernel::ExactVec3 normal;
    kernel::Integer offset;  // c = offset 2^exponent
    long exponent = 0;
  };
  [[nodiscard]] const Exact& exact(OutlineId outline);

  std::span<const Vec3> vertices_;
  Vec3 x_;
  double scale_ = 1.0;
  std::vector<InverseDepth> depths_;
  std::vector<const Piece*> pieces_;
  std::vector<std::uint32_t> exact_at_;  // by outline, into exact_
  std::deque<Exact> exact_;              // the first exact_count_; the rest is spare memory
  std::size_t exact_count_ = 0;
  kernel::Integer left_, right_, dot_;  // scratch
  kernel::ScaledVec3 first_, second_;
};

// --- Windows ---

class Windows {
 public:
  using Lines = std::uint32_t;  // a bit for each of an outline's first 31 edges, the last bit for all others
  static constexpr unsigned kLastLine = 31;

  // An outline that is seen in a window, perhaps in part, with the edges that may cross the window.
  struct SeenOutline {
    OutlineId outline = 0;
    Lines lines = 0;
    // Bounds of the whole outline in the window's coordinates, widened. Of two outlines whose bounds are disjoint in
    // some window, neither covers anything of the other's edges.
    float u_low = 0.0F, u_high = 0.0F, v_low = 0.0F, v_high = 0.0F;

    [[nodiscard]] bool is_beside(const SeenOutline& other) const {
      return u_low > other.u_high || u_high < other.u_low || v_low > other.v_high || v_high < other.v_low;
    }
  };
  // The same from the outline's side. Of a hidden outline `at` is the outline that hides it, otherwise the window, in
  // which the outline has this index.
  struct WindowPlace {
    std::uint32_t at = 0;
    Lines lines = 0;
    std::uint32_t index = 0;
  };

  void find(const Outlines& outlines, std::span<const InverseDepth> depths);

  [[nodiscard]] std::span<const SeenOutline> seen_in(std::uint32_t window) const {
    return std::span(all_seen_).subspan(window_begin_[window], window_begin_[window + 1] - window_begin_[window]);
  }
  [[nodiscard]] const SeenOutline& seen_at(const WindowPlace& place) const { return all_seen_[place.index]; }
  [[nodiscard]] std::span<const WindowPlace> windows_of(OutlineId outline) const { return seen_.of(outline); }
  [[nodiscard]] std::span<const WindowPlace> hidden_by(OutlineId outline) const { return hidden_.of(outline); }
  // Outlines that cover a window together, neither certainly nearer than the other.
  [[nodiscard]] std::span<const std::pair<OutlineId, OutlineId>> rivals() const { return rivals_; }
  [[nodiscard]] std::size_t count() const { return window_begin_.size() - 1; }

 private:
  using Member = SeenOutline;
  struct Window {
    int axis = 0;
    double sign = 1.0;
    double u_low = 0.0, u_high = 0.0, v_low = 0.0, v_high = 0.0;
  };
  // Places in the order of outlines.
  class Index {
   public:
    struct Entry {
      OutlineId outline;
      WindowPlace place;
    };
    void clear() { entries_.clear(); }
    void add(OutlineId outline, const WindowPlace& place) { entries_.push_back({outline, place}); }
    void sort(std::size_t outlines);
    [[nodiscard]] std::span<const WindowPlace> of(OutlineId outline) const {
      return std::span(places_).subspan(begin_[outline], begin_[outline + 1] - begin_[outline]);
    }

   private:
    std::vector<Entry> entries_;
    std::vector<std::uint32_t> begin_, next_;
    std::vector<WindowPlace> places_;
  };

  void start(const Window& face);
  [[nodiscard]] bool enters_face(const Outlines::Outline& outline, const Window& face, Member& member) const;
  void split(const Window& window, std::size_t first, int depth, int stuck);
  void filter(const Window& window, std::size_t first, std::size_t last);
  [[nodiscard]] std::size_t drop_hidden(const Window& window, std::size_t first);
  void keep(std::size_t first);

  const Outlines* outlines_ = nullptr;
  std::span<const InverseDepth> depths_;
  std::vector<Member> members_;  // a stack: those of a window follow those of the window it is part of
  std::vector<SeenOutline> all_seen_;
  std::vector<std::uint32_t> window_begin_;
  Index seen_, hidden_;
  std::vector<std::pair<OutlineId, OutlineId>> rivals_;
};

}  // namespace exactff::whole_view
