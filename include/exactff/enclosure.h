// Enclosures: balls that provably contain a real number. A ball is an interval given by its midpoint and radius.
#pragma once

#include <memory>
#include <optional>
#include <string>

namespace exactff {

class Ball;  // private to the library: midpoint and radius in arbitrary precision

// An enclosure of one real number. Copies are independent. The sum of two enclosures encloses the sum of the two
// numbers (balls can be added; rounded values cannot).
class Enclosure {
 public:
  Enclosure();  // exactly zero
  Enclosure(const Enclosure&);
  Enclosure& operator=(const Enclosure&);
  Enclosure(Enclosure&&) noexcept;
  Enclosure& operator=(Enclosure&&) noexcept;
  ~Enclosure();

  // Exactly this number, which must be finite.
  [[nodiscard]] static Enclosure of(double value);

  Enclosure& operator+=(const Enclosure& other);
  Enclosure& operator-=(const Enclosure& other);  // the same for the difference of two numbers

  // The largest double that is not above the ball's lower end, and the smallest that is not below its upper end.
  [[nodiscard]] double lower() const;
  [[nodiscard]] double upper() const;
  // The double to which every number in the ball rounds (to nearest, ties to even); empty if they do not all round to
  // the same one.
  [[nodiscard]] std::optional<double> nearest() const;
  // The number to `digits` significant decimals, correctly rounded; empty if the ball does not determine them.
  [[nodiscard]] std::optional<std::string> decimals(int digits) const;
  // contains: true if every number in `other` lies in this ball. overlaps: true if the two balls share a number.
  [[nodiscard]] bool contains(const Enclosure& other) const;
  [[nodiscard]] bool overlaps(const Enclosure& other) const;
  [[nodiscard]] bool contains(double value) const;
  // Midpoint and radius in decimals; every number in the ball lies within this radius of this midpoint.
  [[nodiscard]] std::string midpoint() const;
  [[nodiscard]] std::string radius() const;

 private:
  friend struct EnclosureInside;  // see scene.h
  explicit Enclosure(const Ball& ball);
  void set(const Ball& ball);  // reuses the memory of this object
  [[nodiscard]] const Ball& ball() const;

  std::unique_ptr<Ball> ball_;  // null: zero
};

}  // namespace exactff
