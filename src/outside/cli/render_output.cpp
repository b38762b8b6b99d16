#include "cli/render_output.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <system_error>

#include "cli/exit_code.h"
#include "cli/output.h"
#include "files/file.h"
#include "files/numpy.h"
#include "text/escape.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::cli {
namespace {

namespace fs = std::filesystem;

// Opens the file beside its place, as writing it will, and removes it.
void check_file(const std::string& file) {
  std::error_code ignored;
  if (fs::is_other(file, ignored)) return;
  if (fs::is_directory(file, ignored)) {
    text::refuse(fs::path(file), "is a folder", "the result is a file", "name a file");
  }
  const files::WholeFile probe(file);
}

void write_array(const std::string& file, const std::vector<std::size_t>& shape,
                 const std::vector<const std::vector<double>*>& parts) {
  files::NpyFile<double> array(file, shape);
  for (const std::vector<double>* part : parts) array.append(*part);
  array.commit();
}

std::string took(const render::Picture& picture) { return text::duration(picture.seconds); }

// Not read from a file.
bool is_computed(const render::Picture& picture) { return picture.seconds > 0.0; }

std::string error_words(const render::Errors& errors) {
  return "RMS " + text::short_number(errors.rms) + ", 99th percentile " + text::short_number(errors.p99) + ", worst " +
         text::short_number(errors.worst);
}

std::string wrong_words(const render::Errors& errors) {
  return text::share(errors.wrong, errors.pixels) + " of pixels wrong by over 10 %";
}

// For a method with a formula of its own, that name; the exact values have none.
std::string name_of_picture(const render::Picture& picture) {
  const auto found = std::ranges::find(picture.metadata, "method", &std::pair<std::string, std::string>::first);
  return found == picture.metadata.end() ? "" : found->second.substr(0, found->second.find(", correctly"));
}

render::Colours strip_of(const Rendered& rendered, double exposure) {
  const double scale = render::colour_scale(*rendered.errors);
  return render::strip(std::array{render::develop(rendered.picture, exposure),
                                  render::develop(*rendered.judged, exposure),
                                  render::coloured(*rendered.errors, rendered.picture.size, scale)});
}

// What the strip shows, from left to right.
std::string strip_words(const Rendered& rendered) {
  const double scale = render::colour_scale(*rendered.errors);
  return name_of_picture(rendered.picture) + " | " + rendered.judged_name +
         " | errors: red too bright, blue too dark, full colour from " + text::short_number(scale, 2) +
         " on, black outlines around regions that are mostly wrong by over 10 %";
}

std::string image_bytes(const RenderFiles& files, const Rendered& rendered) {
  const bool png = render::image_kind(files.image) == render::ImageKind::kPng;
  const auto exposure = [&] { return files.exposure ? *files.exposure : render::automatic_exposure(rendered.picture); };
  render::Metadata metadata = rendered.picture.metadata;
  if (files.strip) {
    metadata.emplace_back("strip", strip_words(rendered));
    return render::png_of(strip_of(rendered, exposure()), metadata);
  }
  if (rendered.errors) {
    if (!png) return render::exr_of(render::difference(*rendered.judged, rendered.picture));
    const double scale = render::colour_scale(*rendered.errors);
    return render::png_of(render::coloured(*rendered.errors, rendered.picture.size, scale),
                          render::difference(*rendered.judged, rendered.picture).metadata);
  }
  return png ? render::png_of(render::develop(rendered.picture, exposure()), metadata)
             : render::exr_of(rendered.picture);
}

std::string words_of_pixels(const render::Picture& picture) {
  std::array<std::uint64_t, 4> count{};
  for (const render::Shows shows : picture.shows) ++count[static_cast<std::size_t>(shows)];
  constexpr std::array kNames = {"show nothing", "black backs", "lit faces", "emitters"};
  std::string words;
  for (const std::size_t kind : {2U, 3U, 1U, 0U}) {
    if (count[kind] > 0) words += (words.empty() ? "" : ", ") + std::to_string(count[kind]) + ' ' + kNames[kind];
  }
  return words;
}

}  // namespace

void check_files(const std::vector<std::string>& images, const std::vector<std::string>& arrays) {
  for (const std::string& file : images) check_file(file);
  for (const std::string& file : arrays) {
    if (file.empty()) continue;
    if (fs::path(file).extension() != ".npy") {
      text::refuse(fs::path(file), "does not end in .npy", "it is a NumPy file, which other programs recognise by that",
                   "name a .npy file");
    }
    check_file(file);
  }
}

void write_files(const RenderFiles& files, const Rendered& rendered) {
  const render::Picture& picture = rendered.picture;
  const auto height = static_cast<std::size_t>(picture.size.height),
             width = static_cast<std::size_t>(picture.size.width);
  const std::string image = image_bytes(files, rendered);
  if (!files.doubles.empty()) write_array(files.doubles, {height, width, 3}, {&picture.values});
  if (!files.bounds.empty()) write_array(files.bounds, {2, height, width, 3}, {&picture.lower, &picture.upper});
  write_whole_file(files.image, image);
}

void print_rendered(const Rendered& rendered, const RenderFiles& files, const std::string& camera) {
  const render::Picture& picture = rendered.picture;
  std::cout << picture.size.width << " x " << picture.size.height << " pixels: " << words_of_pixels(picture) << '\n';
  std::cout << "computed in " << took(picture) << " of processor time";
  if (rendered.judged && is_computed(*rendered.judged))
    std::cout << ", " << text::printable(rendered.judged_name) << " in " << took(*rendered.judged);
  std::cout << '\n';
  if (!camera.empty()) std::cout << "camera: " << camera << '\n';
  if (rendered.errors) {
    const render::Errors& errors = *rendered.errors;
    std::cout << "errors: " << error_words(errors) << "; relative: median "
              << text::short_number(errors.relative_median) << ", 99th percentile "
              << text::short_number(errors.relative_p99) << "; " << wrong_words(errors) << '\n';
  }
  if (files.strip) std::cout << "strip: " << text::printable(strip_words(rendered)) << '\n';
  const bool develops = render::image_kind(files.image) == render::ImageKind::kPng && (files.strip || !rendered.errors);
  if (develops && !files.exposure) {
    std::cout << "automatic exposure: " << text::short_number(render::automatic_exposure(picture), 6) << '\n';
  }
  std::cout << "Image: " << text::printable(files.image) << '\n';
}

int warn_of_uncertified_points(const Rendered& rendered) {
  const std::uint64_t points = rendered.picture.not_certified;
  if (points == 0) return 0;
  std::cerr << "exactff: the values of " << text::counted(points, "point")
            << " could not be certified within the precision cap; they are estimates, and their bounds are valid\n";
  return kNotAsAsked;
}

}  // namespace exactff::cli
