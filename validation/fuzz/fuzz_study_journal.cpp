// Arbitrary bytes as the journal of an interrupted study. The bytes after the first byte are the journal itself or, if
// the first byte is odd, edits of a valid one (edits.h). If its second bit is set, the edits change blocks and update
// their checksums, so that the code behind the checksums is reached, too.
//
// A journal with valid checksums gives the values of an undisturbed run, or is refused with a message. A journal with
// forged checksums may contain wrong values, which cannot be detected; it must do no other harm.
#include <algorithm>
#include <cstdint>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>

#include "exactff/study.h"
#include "fuzz/complaints.h"
#include "fuzz/edits.h"
#include "jobs/blocks.h"
#include "report/report.h"
#include "support/program.h"
#include "text/hashes.h"
#include "unit/reports/study_support.h"

namespace exactff::validation {
namespace {

namespace fs = std::filesystem;

study::Request request_of(const Scene& scene) {
  study::Request request = small_request(scene, 1);
  request.receivers.resize(2);
  request.sweeps.eps_b = {0.5};
  request.sweeps.seeds = {1};
  request.sweeps.patterns = {SamplePattern::kJittered};
  request.sweeps.variants = {Variant::kMended};
  scatter(request);
  return request;
}

using Tables = std::map<std::string, std::string>;

fs::path file() {
  static const TemporaryDirectory directory(memory_folder());
  return directory.path() / "study.part";
}

// The values of an undisturbed run, and the journal that it would leave if it were interrupted at its end.
struct Truth {
  Tables tables;
  std::string journal;
};

Truth make_truth(const Scene& scene) {
  jobs::Journal journal(file(), jobs::Existing::kReplace);
  Tables tables = value_tables(study::run(request_of(scene), {}, &journal));
  const std::string text = text_of(file());
  journal.remove();
  if (text.find('\n') + 1 >= text.size()) fail("no journal to begin with");
  return {std::move(tables), text};
}

// Edits blocks of a valid journal, with a new checksum for each.
std::string with_edited_blocks(const std::string& journal, Bytes& bytes) {
  const std::size_t head = journal.find('\n') + 1;
  std::string out = journal.substr(0, head);
  std::ofstream(file(), std::ios::binary) << journal;
  const files::File whole(file(), files::File::Mode::kRead);
  for (const jobs::Block& block : jobs::find_blocks(whole, head, "work").list) {
    std::string content = jobs::read_bytes(whole, block);
    if (bytes.next() % 4 == 0) content = edited(content, bytes);
    out += jobs::block_text("work", block.name, content);
  }
  return out;
}

void check(const std::string& text, const Scene& scene, const Tables* expected) {
  std::ofstream(file(), std::ios::binary) << text;
  try {
    jobs::Journal journal(file(), jobs::Existing::kResume);
    const Tables found = value_tables(study::run(request_of(scene), {}, &journal));
    if (expected != nullptr && found != *expected) fail("resumed to other values");
    journal.remove();
  } catch (const InputError& error) {
    require_words(error);
    if (text_of(file()) != text) fail("refused, and changed");
  } catch (const std::logic_error&) {
    if (expected != nullptr) throw;  // forged values may contradict computed ones, which is detected
  }
}

}  // namespace
}  // namespace exactff::validation

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace exactff;
  using namespace exactff::validation;
  static const Scene scene = small_room(true);
  static const Truth truth = make_truth(scene);
  Bytes bytes({data, size});
  const std::uint8_t mode = bytes.next();
  const std::string raw(reinterpret_cast<const char*>(data) + std::min<std::size_t>(size, 1),
                        size - std::min<std::size_t>(size, 1));
  const bool forged = (mode & 2) != 0;
  const std::string journal = forged            ? with_edited_blocks(truth.journal, bytes)
                              : (mode & 1) != 0 ? edited(truth.journal, bytes)
                                                : raw;
  check(journal, scene, forged ? nullptr : &truth.tables);
  (void)page::chapter_of(raw);
  return 0;
}
