// Results that are read from a journal instead of being computed again, as 64-bit words for the same machine. A struct
// lists its fields once, for both directions:
//
//   template <class Words>
//   void fields(Words& words, Result& result) { words(result.value, result.name); }
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exactff/jobs.h"
#include "text/hashes.h"

namespace exactff::jobs {

class WordWriter {
 public:
  template <class... Field>
  void operator()(Field&... field) {
    (put(field), ...);
  }
  // An enumerator; there are `count`.
  template <class Enum>
  void choice(Enum& value, std::uint64_t /*count*/) {
    put(static_cast<std::uint64_t>(value));
  }
  // Calls write(item) for every item.
  template <class Item, class Write>
  void list(std::vector<Item>& items, const Write& write) {
    put(std::uint64_t{items.size()});
    for (Item& item : items) write(item);
  }
  // A list that always has `count` items.
  template <class Item>
  void list_of(std::size_t /*count*/, std::vector<Item>& items) {
    put(items);
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  void put(bool value) { put(std::uint64_t{value}); }
  void put(double value) { put(std::bit_cast<std::uint64_t>(value)); }
  void put(std::uint64_t word) { bytes_.append(reinterpret_cast<const char*>(&word), sizeof word); }
  void put(const std::string& text) {
    put(std::uint64_t{text.size()});
    bytes_.append(text);
    bytes_.append((8 - text.size() % 8) % 8, '\0');
  }
  template <class Item>
  void put(std::vector<Item>& items) {
    list(items, [&](Item& item) { put(item); });
  }

  std::string bytes_;
};

// Missing words at the end read as 0. `complete` is false if words were missing or were left unread.
class WordReader {
 public:
  explicit WordReader(std::string_view bytes) : bytes_(bytes) {}

  template <class... Field>
  void operator()(Field&... field) {
    (take(field), ...);
  }
  // A word that is no enumerator counts as torn.
  template <class Enum>
  void choice(Enum& value, std::uint64_t count) {
    const std::uint64_t read = word();
    torn_ = torn_ || read >= count;
    value = static_cast<Enum>(read < count ? read : 0);
  }
  // Calls read(item) for every item, unless the bytes left cannot hold the stated number of items.
  template <class Item, class Read>
  void list(std::vector<Item>& items, const Read& read) {
    items.clear();
    const std::uint64_t count = word();
    torn_ = torn_ || count > bytes_.size() / sizeof count;
    while (!torn_ && items.size() < count) read(items.emplace_back());
  }
  // A list of another length counts as torn.
  template <class Item>
  void list_of(std::size_t count, std::vector<Item>& items) {
    take(items);
    torn_ = torn_ || items.size() != count;
  }
  [[nodiscard]] bool torn() const { return torn_; }
  [[nodiscard]] bool complete() const { return !torn_ && bytes_.empty(); }

 private:
  void take(bool& value) { value = word() != 0; }
  void take(double& value) { value = std::bit_cast<double>(word()); }
  void take(std::uint64_t& value) { value = word(); }
  void take(std::string& text) {
    const std::uint64_t size = word();
    torn_ = torn_ || size > bytes_.size() || (size + 7) / 8 * 8 > bytes_.size();
    text = torn_ ? std::string() : std::string(bytes_.substr(0, size));
    if (!torn_) bytes_.remove_prefix((size + 7) / 8 * 8);
  }
  template <class Item>
  void take(std::vector<Item>& items) {
    list(items, [&](Item& item) { take(item); });
  }

  std::uint64_t word() {
    std::uint64_t result = 0;
    torn_ = torn_ || bytes_.size() < sizeof result;
    if (torn_) return 0;
    std::memcpy(&result, bytes_.data(), sizeof result);
    bytes_.remove_prefix(sizeof result);
    return result;
  }

  std::string_view bytes_;
  bool torn_ = false;
};

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
      WordReader words(*bytes);
      fields(words);
      if (words.complete()) return;
    }
    compute();
    WordWriter words;
    fields(words);
    journal_->add(key, words.bytes());
  }

 private:
  Journal* journal_;
  std::string prefix_;
};

}  // namespace exactff::jobs
