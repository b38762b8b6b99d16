// The writers, each of one format. They return the bytes of the file and add what it does not hold to `losses`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "exactff/scene.h"

namespace exactff::formats {

// What a format does not hold of a scene, as warnings about the file to be written.
class Losses {
 public:
  explicit Losses(const std::filesystem::path& path) : file_(path.string()) {}

  void add(std::string what, std::string why, std::string suggestion) {
    problems_.push_back({file_, 0, std::move(what), std::move(why), std::move(suggestion)});
  }
  // For formats without materials: adds Kd and Ke of the faces, if they are not 1 and 0.
  void add_materials(const Scene& scene, const std::string& format);

  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] std::vector<Problem> take() { return std::move(problems_); }

 private:
  std::string file_;
  std::vector<Problem> problems_;
};

// Appends the shortest decimal that reads back to the same double.
void append_number(std::string& out, double value);
// "x y z", with a blank before each.
void append_point(std::string& out, const Vec3& point);

[[nodiscard]] bool needs_mtl(const Scene& scene);
// `mtl` is the name of the material file; empty if there is none.
[[nodiscard]] std::string write_obj(const Scene& scene, const std::string& mtl, Losses& losses);
// To be called with the same scene: material names are changed in the same way.
[[nodiscard]] std::string write_mtl(const Scene& scene, Losses& losses);
[[nodiscard]] std::string write_off(const Scene& scene, Losses& losses);
[[nodiscard]] std::string write_ply_text(const Scene& scene, Losses& losses);
[[nodiscard]] std::string write_ply_binary(const Scene& scene, Losses& losses);
[[nodiscard]] std::string write_stl_text(const Scene& scene, Losses& losses);
[[nodiscard]] std::string write_stl_binary(const Scene& scene, Losses& losses);
[[nodiscard]] std::string write_view3d(const Scene& scene, Losses& losses);

}  // namespace exactff::formats
