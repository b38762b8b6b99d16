// What is found in a journal instead of being computed again.
#pragma once

#include <string>
#include <utility>

#include "exactff/study.h"
#include "scene/fnv1a.h"
#include "study/words.h"

namespace exactff::study {

// Tells one text from another: for the names of pieces of work, which hold no blanks.
[[nodiscard]] inline std::string short_hash(std::string_view text) {
  Fnv1a hash;
  hash.add_bytes(text);
  return hash.digits();
}

// Names of this study's pieces of work begin with `prefix`, which tells it from others by all that its values depend
// on.
class KeptWork {
 public:
  KeptWork(Journal* journal, std::string prefix) : journal_(journal), prefix_(std::move(prefix)) {}

  // By read(WordReader&) from the journal, else by compute(), which write(WordWriter&) then keeps. From any thread.
  template <class Compute, class Write, class Read>
  void get(const std::string& name, const Compute& compute, const Write& write, const Read& read) const {
    if (journal_ == nullptr) return compute();
    const std::string key = prefix_ + '/' + name;
    if (const auto bytes = journal_->find(key)) {
      WordReader words(*bytes);
      read(words);
      if (words.complete()) return;
    }
    compute();
    WordWriter words;
    write(words);
    journal_->add(key, words.bytes());
  }

 private:
  Journal* journal_;
  std::string prefix_;
};

}  // namespace exactff::study
