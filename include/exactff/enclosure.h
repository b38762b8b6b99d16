// A ball that is proved to hold a real number.
#pragma once

#include <memory>
#include <optional>
#include <string>

namespace exactff {

class Ball;  // kernel/ball.h: midpoint and radius in arbitrary precision

// Value semantics; adding two enclosures encloses the sum (balls add, rounded values do not).
class Enclosure {
 public:
  Enclosure();  // exactly zero
  explicit Enclosure(const Ball& ball);
  Enclosure(const Enclosure&);
  Enclosure& operator=(const Enclosure&);
  Enclosure(Enclosure&&) noexcept;
  Enclosure& operator=(Enclosure&&) noexcept;
  ~Enclosure();

  // As if made anew from the ball, in the memory that this has.
  void set(const Ball& ball);

  Enclosure& operator+=(const Enclosure& other);

  // The largest double not above the number's lower bound, the smallest not below its upper bound.
  [[nodiscard]] double lower() const;
  [[nodiscard]] double upper() const;
  // The nearest double (ties to even) of every number in the ball, if that is one and the same.
  [[nodiscard]] std::optional<double> nearest() const;
  // `digits` significant decimals, correctly rounded, if the ball determines them.
  [[nodiscard]] std::optional<std::string> decimals(int digits) const;
  // True if every number in `other` is in this ball; if the two balls share a number.
  [[nodiscard]] bool contains(const Enclosure& other) const;
  [[nodiscard]] bool overlaps(const Enclosure& other) const;
  [[nodiscard]] bool contains(double value) const;
  // Decimal midpoint and radius; every number in the ball lies within radius of midpoint.
  [[nodiscard]] std::string midpoint() const;
  [[nodiscard]] std::string radius() const;

  [[nodiscard]] const Ball& ball() const;

 private:
  std::unique_ptr<Ball> ball_;  // null: zero
};

}  // namespace exactff
