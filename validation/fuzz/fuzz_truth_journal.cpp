// Arbitrary bytes as the journal of an interrupted truth run. The bytes after the first byte are the journal itself or,
// if the first byte is odd, edits of a valid one (edits.h). If its second bit is set, the checksums of its blocks are
// corrected, so that the code behind the checksums is reached, too.
//
// A journal with valid checksums is resumed to the bytes of an undisturbed run, or refused with a message. A journal
// with forged checksums may contain wrong rows, which cannot be detected; it must do no other harm.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "exactff/truth.h"
#include "fuzz/complaints.h"
#include "fuzz/edits.h"
#include "generate/plain_scene.h"
#include "jobs/journal.h"
#include "support/program.h"

namespace exactff::validation {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kOpening = "# rows ";

// Two chunks of rows: several blocks, in any order.
Scene room() {
  generate::PlainScene plain;
  plain.add_ring(plain.patch("light"), {{-1, 1, 2}, {1, 1, 2}, {1, -1, 2}, {-1, -1, 2}});
  plain.add_ring(plain.patch("plate"), {{0, 0, 1}, {2, 0, 1}, {0, 2, 1}});
  plain.add_ring(plain.patch("floor"), {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}});
  return generate::build(plain);
}

truth::Request request_of(const Scene& scene) {
  truth::Request request;
  request.scene = &scene;
  request.scene_name = "room.obj";
  request.receivers = grid_receivers(scene, scene.select("floor"), {9, 8});
  request.receivers_name = "floor, grid 9x8";
  request.sources = {scene.select("light")};
  request.threads = 1;
  return request;
}

// "# rows FIRST+COUNT, ..." and the lines up to the next opening, whatever bytes and checksum it tells.
std::string mended_block(std::string_view text) {
  jobs::Range range;
  const std::size_t plus = text.find('+'), line_end = text.find('\n');
  if (line_end == std::string_view::npos || plus > line_end) return std::string(text);
  range.first = std::strtoull(std::string(text.substr(kOpening.size(), 20)).c_str(), nullptr, 10);
  range.rows = static_cast<std::uint32_t>(std::strtoul(std::string(text.substr(plus + 1, 10)).c_str(), nullptr, 10));
  return jobs::block_text(range, text.substr(line_end + 1));
}

std::string mended(std::string_view text) {
  std::size_t at = std::min(text.find(kOpening), text.size());
  std::string out(text.substr(0, at));
  while (at < text.size()) {
    const std::size_t next = std::min(text.find(kOpening, at + 1), text.size());
    out += mended_block(text.substr(at, next - at));
    at = next;
  }
  return out;
}

const TemporaryDirectory& directory() {
  static const TemporaryDirectory one(memory_folder());
  return one;
}

// The file of an undisturbed run, and the journal of an interrupted one.
struct Texts {
  std::string whole, journal;
};

Texts make_texts(const Scene& scene) {
  const fs::path file = directory().path() / "whole.csv";
  int rows = 0;
  try {
    (void)truth::write(request_of(scene), file, jobs::Existing::kRefuse, {.cancelled = [&] { return ++rows > 60; }});
  } catch (const Cancelled&) {
  }
  Texts texts{{}, text_of(jobs::journal_of(file))};
  (void)truth::write(request_of(scene), file, jobs::Existing::kResume);
  texts.whole = text_of(file);
  if (texts.journal.find(kOpening) == std::string::npos) fail("no journal to begin with");
  return texts;
}

void check(const std::string& journal, const Scene& scene, const std::string* expected) {
  const fs::path file = directory().path() / "truth.csv";
  fs::remove(file);
  (void)directory().write("truth.csv.part", journal);
  try {
    const truth::Summary summary = truth::write(request_of(scene), file, jobs::Existing::kResume);
    if (summary.rows != 72 || summary.resumed > summary.rows) fail("a count of rows that cannot be");
    if (expected != nullptr && text_of(file) != *expected) fail("resumed to other bytes");
    if (fs::exists(jobs::journal_of(file))) fail("a journal left behind");
  } catch (const InputError& error) {
    require_words(error);
    if (fs::exists(file)) fail("refused, and written");
  }
}

}  // namespace
}  // namespace exactff::validation

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace exactff::validation;
  static const exactff::Scene scene = room();
  static const Texts texts = make_texts(scene);
  Bytes bytes({data, size});
  const std::uint8_t mode = bytes.next();
  const std::string raw(reinterpret_cast<const char*>(data) + std::min<std::size_t>(size, 1),
                        size - std::min<std::size_t>(size, 1));
  const std::string journal = (mode & 1) != 0 ? edited(texts.journal, bytes) : raw;
  const bool forged = (mode & 2) != 0;
  check(forged ? mended(journal) : journal, scene, forged ? nullptr : &texts.whole);
  return 0;
}
