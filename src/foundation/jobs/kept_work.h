// Results that are read from a journal instead of being computed again.
#pragma once

#include <string>
#include <utility>

#include "exactff/jobs.h"
#include "files/fields.h"
#include "text/hashes.h"

namespace exactff::jobs {

// A hash that distinguishes texts, without blanks: for the names of pieces of work.
[[nodiscard]] inline std::string short_hash(std::string_view text) {
  text::Fnv1a hash;
  hash.add_bytes(text);
  return hash.digits();
}

// The names of this study's pieces of work begin with `prefix`, which differs if anything differs that the values
// depend on.
class KeptWork {
 public:
  KeptWork(Journal* journal, std::string prefix) : journal_(journal), prefix_(std::move(prefix)) {}

  // fields(words) lists the fields of the result. Reads them if the journal has the result; otherwise calls compute()
  // and keeps them. Safe from any thread.
  template <class Compute, class Fields>
  void get(const std::string& name, const Compute& compute, const Fields& fields) const {
    if (journal_ == nullptr) return compute();
    const std::string key = prefix_ + '/' + name;
    if (const auto bytes = journal_->find(key)) {
      files::WordReader words(*bytes);
      fields(words);
      if (words.complete()) return;
    }
    compute();
    files::WordWriter words;
    fields(words);
    journal_->add(key, words.bytes());
  }

 private:
  Journal* journal_;
  std::string prefix_;
};

}  // namespace exactff::jobs
