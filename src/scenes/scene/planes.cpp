// Pieces are first sorted by a hash that is the same for all pieces of one plane. Pieces of one hash are then compared
// exactly.
//
// The hash. A plane n . y = d has homogeneous coordinates (n, d), rational numbers that are known up to a factor. They
// are computed modulo the prime p = 2^31 - 1, which divides no power of 2, and divided by the first one that is not 0.
// That is the same for all pieces of one plane, unless the factor between the n of two pieces is divisible by p. Then
// one n is 0 modulo p. Such an n is replaced by the primitive integers along it, and these are not all divisible by p.
#include "scene/planes.h"

#include <algorithm>
#include <array>
#include <utility>

#include "kernel/exact_vec.h"
#include "kernel/plane_through.h"
#include "kernel/split_mix.h"
#include "scene/scene_data.h"

namespace exactff {
namespace {

using Residue = std::uint64_t;  // below kPrime
using Residues = std::array<Residue, 3>;

constexpr int kPrimeBits = 31;
constexpr Residue kPrime = (Residue{1} << kPrimeBits) - 1;

// 2^31 is 1 modulo p.
Residue reduced(std::uint64_t a) {
  a = (a & kPrime) + (a >> kPrimeBits);
  a = (a & kPrime) + (a >> kPrimeBits);
  return a >= kPrime ? a - kPrime : a;
}

Residue times_power_of_two(Residue a, long exponent) {
  const long turn = exponent % kPrimeBits;
  return reduced(a << (turn < 0 ? turn + kPrimeBits : turn));
}

Residue negative(Residue a) { return a == 0 ? 0 : kPrime - a; }

Residue residue(double value) {
  const kernel::BinaryDouble parts = kernel::decompose(value);
  const bool is_negative = parts.mantissa < 0;
  const auto magnitude = static_cast<std::uint64_t>(is_negative ? -parts.mantissa : parts.mantissa);
  const Residue result = times_power_of_two(reduced(magnitude), parts.exponent);
  return is_negative ? negative(result) : result;
}

Residues residues_of(const Vec3& v) { return {residue(v.x), residue(v.y), residue(v.z)}; }

Residue residue(const kernel::Integer& value) { return mpz_fdiv_ui(value.get_mpz_t(), kPrime); }

Residues difference(const Residues& a, const Residues& b) {
  return {reduced(a[0] + kPrime - b[0]), reduced(a[1] + kPrime - b[1]), reduced(a[2] + kPrime - b[2])};
}

Residues cross(const Residues& a, const Residues& b) {
  const auto determinant = [&](int i, int j) { return reduced(a[i] * b[j] + (kPrime - a[j]) * b[i]); };
  return {determinant(1, 2), determinant(2, 0), determinant(0, 1)};
}

Residue dot(const Residues& a, const Residues& b) { return reduced(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]); }

// By Fermat: a^(p - 2).
Residue inverse(Residue a) {
  Residue result = 1;
  for (std::uint64_t exponent = kPrime - 2; exponent > 0; exponent >>= 1U) {
    if ((exponent & 1U) != 0) result = reduced(result * a);
    a = reduced(a * a);
  }
  return result;
}

// Of residues that are not 0, by one inverse for all (Montgomery).
std::vector<Residue> inverses(const std::vector<Residue>& values) {
  std::vector<Residue> products{1};
  for (const Residue value : values) products.push_back(reduced(products.back() * value));
  Residue rest = inverse(products.back());
  std::vector<Residue> result(values.size());
  for (std::size_t i = values.size(); i > 0; --i) {
    result[i - 1] = reduced(rest * products[i - 1]);
    rest = reduced(rest * values[i - 1]);
  }
  return result;
}

class PlaneFinder {
 public:
  explicit PlaneFinder(const Scene& scene) : scene_(scene), at_(scene.vertices().size()) {
    std::ranges::transform(scene.vertices(), at_.begin(), [](const Vec3& vertex) { return residues_of(vertex); });
  }

  // For each piece, the first one in its plane.
  [[nodiscard]] std::vector<std::uint32_t> first_pieces() const {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> hashed = hashes();
    std::ranges::sort(hashed);
    std::vector<std::uint32_t> first(hashed.size());
    for (auto run = hashed.begin(); run != hashed.end();) {
      const auto end = std::find_if(run, hashed.end(), [&](const auto& other) { return other.first != run->first; });
      set_first_pieces({run, end}, first);
      run = end;
    }
    return first;
  }

 private:
  void set_first_pieces(std::span<const std::pair<std::uint64_t, std::uint32_t>> run,
                        std::vector<std::uint32_t>& first) const {
    std::vector<std::pair<kernel::PlaneThrough, std::uint32_t>> known;
    for (const auto& hashed : run) {
      const Piece& piece = scene_.pieces()[hashed.second];
      const auto holds = [&](const auto& plane) { return holds_all(plane.first, piece); };
      const auto plane = std::ranges::find_if(known, holds);
      first[hashed.second] = plane == known.end() ? hashed.second : plane->second;
      if (plane == known.end() && run.size() > 1) known.emplace_back(plane_through(piece), hashed.second);
    }
  }

  [[nodiscard]] const Vec3& corner(const Piece& piece, int i) const { return scene_.vertices()[piece.frame[i]]; }
  [[nodiscard]] kernel::PlaneThrough plane_through(const Piece& piece) const {
    return {corner(piece, 0), corner(piece, 1), corner(piece, 2)};
  }
  [[nodiscard]] bool holds_all(const kernel::PlaneThrough& plane, const Piece& piece) const {
    return plane.side_of(corner(piece, 0)) == 0 && plane.side_of(corner(piece, 1)) == 0 &&
           plane.side_of(corner(piece, 2)) == 0;
  }

  [[nodiscard]] std::vector<std::pair<std::uint64_t, std::uint32_t>> hashes() const {
    std::vector<Residues> normals;
    std::vector<Residue> first;  // that is not 0
    for (const Piece& piece : scene_.pieces()) {
      const Residues& n = normals.emplace_back(normal_of(piece));
      first.push_back(n[0] != 0 ? n[0] : n[1] != 0 ? n[1] : n[2]);
    }
    const std::vector<Residue> by = inverses(first);
    std::vector<std::pair<std::uint64_t, std::uint32_t>> result;
    for (std::uint32_t piece = 0; piece < normals.size(); ++piece) {
      const Residues& n = normals[piece];
      std::uint64_t hash = 0;
      for (const Residue component : {n[0], n[1], n[2], dot(n, at_[scene_.pieces()[piece].frame[0]])}) {
        hash = kernel::split_mix(hash, reduced(component * by[piece]));
      }
      result.emplace_back(hash, piece);
    }
    return result;
  }

  [[nodiscard]] Residues normal_of(const Piece& piece) const {
    const Residues& a = at_[piece.frame[0]];
    const Residues n = cross(difference(at_[piece.frame[1]], a), difference(at_[piece.frame[2]], a));
    return n == Residues{} ? primitive_normal(piece) : n;
  }

  [[nodiscard]] Residues primitive_normal(const Piece& piece) const {
    kernel::ExactVec3 n = kernel::cross(kernel::exact_difference(corner(piece, 1), corner(piece, 0)).v,
                                        kernel::exact_difference(corner(piece, 2), corner(piece, 0)).v);
    kernel::make_primitive(n);
    return {residue(n.x), residue(n.y), residue(n.z)};
  }

  const Scene& scene_;
  std::vector<Residues> at_;  // of the vertices
};

}  // namespace

Planes::Planes(const Scene& scene) {
  const std::vector<std::uint32_t> first = PlaneFinder(scene).first_pieces();
  std::uint32_t found = 0;
  for (std::uint32_t piece = 0; piece < first.size(); ++piece) {
    of_piece_.push_back(first[piece] == piece ? PlaneId{found++} : of_piece_[first[piece]]);
  }
  sort_pieces(found);
}

void Planes::sort_pieces(std::size_t found) {
  first_.assign(found + 1, 0);
  for (const PlaneId plane : of_piece_) ++first_[index_of(plane) + 1];
  for (std::size_t i = 0; i < found; ++i) first_[i + 1] += first_[i];
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  pieces_.resize(of_piece_.size());
  for (std::uint32_t piece = 0; piece < of_piece_.size(); ++piece) {
    pieces_[next[index_of(of_piece_[piece])]++] = piece;
  }
}

const Planes& planes(const Scene& scene) {
  const SceneInside::Data& data = SceneInside::data(scene);
  std::call_once(data.planes_found, [&] { data.planes = Planes(scene); });
  return data.planes;
}

}  // namespace exactff
