// NumPy files, byte by byte. validation/vtk reads some with NumPy.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "exactff/error.h"
#include "files/numpy.h"
#include "support/program.h"

namespace exactff::files {
namespace {

using Shape = std::vector<std::size_t>;

class NpyFiles : public testing::Test {
 protected:
  const validation::TemporaryDirectory directory_{validation::memory_folder()};
  const std::filesystem::path path_ = directory_.path() / "array.npy";
};

// The dictionary of a header, without its padding.
std::string dictionary(const std::string& bytes) {
  const auto length = static_cast<std::size_t>(static_cast<unsigned char>(bytes.at(8))) +
                      256 * static_cast<std::size_t>(static_cast<unsigned char>(bytes.at(9)));
  EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  EXPECT_EQ(bytes.size(), 10 + length);
  EXPECT_EQ(bytes.size() % 64, 0U);
  EXPECT_EQ(bytes.back(), '\n');
  return bytes.substr(10, bytes.find_last_not_of(" \n") - 9);
}

std::string dictionary(std::string_view type, const Shape& shape) { return dictionary(npy_header(type, shape)); }

TEST_F(NpyFiles, StateTypeOrderAndShapeAsPythonWritesThem) {
  EXPECT_EQ(dictionary("<f8", {3, 4}), "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 4), }");
  EXPECT_EQ(dictionary("<f4", {5, 6, 3}), "{'descr': '<f4', 'fortran_order': False, 'shape': (5, 6, 3), }");
  EXPECT_EQ(dictionary("|u1", {7}), "{'descr': '|u1', 'fortran_order': False, 'shape': (7,), }");
  EXPECT_EQ(dictionary("<i8", {}), "{'descr': '<i8', 'fortran_order': False, 'shape': (), }");
  EXPECT_EQ(dictionary("<f8", {0, 2}), "{'descr': '<f8', 'fortran_order': False, 'shape': (0, 2), }");
}

TEST_F(NpyFiles, HoldEveryBitInOrder) {
  const std::vector<double> values{
      0.0, -0.0, 1.0 / 3, std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::quiet_NaN(), 1e308};
  write_npy<double>(path_, Shape{2, 3}, values);
  const std::string bytes = validation::text_of(path_);
  ASSERT_EQ(bytes.size(), 128 + 6 * sizeof(double));
  EXPECT_EQ(dictionary(bytes.substr(0, 128)), "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }");
  EXPECT_EQ(std::memcmp(&bytes[128], values.data(), 6 * sizeof(double)), 0);
}

TEST_F(NpyFiles, GrowByElementsAndByManyAtOnce) {
  std::vector<float> values(200'001);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
  NpyFile<float> file(path_, Shape{200'002});
  file.append(std::span<const float>(values));
  file.append(-1.0F);
  file.commit();
  values.push_back(-1.0F);
  const std::string bytes = validation::text_of(path_);
  ASSERT_EQ(bytes.size(), 128 + values.size() * sizeof(float));
  EXPECT_EQ(std::memcmp(&bytes[128], values.data(), values.size() * sizeof(float)), 0);
}

TEST_F(NpyFiles, AppearWholeOrNotAtAll) {
  write_npy<double>(path_, Shape{1}, std::array{1.0});
  const std::string before = validation::text_of(path_);
  {
    NpyFile<double> file(path_, Shape{2});
    file.append(2.0);
    EXPECT_THROW(file.commit(), std::logic_error);
    EXPECT_THROW(file.append(std::array{3.0, 4.0}), std::logic_error);
  }
  EXPECT_EQ(validation::text_of(path_), before);
  EXPECT_FALSE(std::filesystem::exists(path_.string() + ".whole"));
  EXPECT_THROW(write_npy<double>(directory_.path() / "none" / "array.npy", Shape{0}, {}), InputError);
}

}  // namespace
}  // namespace exactff::files
