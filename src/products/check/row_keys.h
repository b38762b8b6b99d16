// Finds rows by their receiver and source.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

namespace exactff::check {

// " of source 'light'", or empty if sources have no names.
inline std::string of_source(const std::string& source) { return source.empty() ? "" : " of source '" + source + "'"; }

// A set of indices into a list of rows, which is not copied.
template <class Row>
class RowKeys {
 public:
  explicit RowKeys(const std::vector<Row>& rows) : rows_(rows), set_(rows.size(), Hash{&rows}, Equal{&rows}) {}

  // The index of the first row with the same receiver and source: `index` itself if it is the first.
  std::uint32_t insert(std::uint32_t index) { return *set_.insert(index).first; }

  // The index of the row; the number of rows if there is none.
  [[nodiscard]] std::size_t find(std::string_view receiver, std::uint32_t source) const {
    const auto found = set_.find(Key{receiver, source});
    return found == set_.end() ? rows_.size() : *found;
  }

 private:
  struct Key {
    std::string_view receiver;
    std::uint32_t source;
  };
  static Key key_of(const Row& row) { return {row.receiver, row.source}; }

  struct Hash {
    using is_transparent = void;
    const std::vector<Row>* rows;
    std::size_t operator()(const Key& key) const {
      return std::hash<std::string_view>{}(key.receiver) ^ (key.source * std::size_t{0x9E3779B97F4A7C15});
    }
    std::size_t operator()(std::uint32_t index) const { return (*this)(key_of((*rows)[index])); }
  };
  struct Equal {
    using is_transparent = void;
    const std::vector<Row>* rows;
    [[nodiscard]] Key key(std::uint32_t index) const { return key_of((*rows)[index]); }
    [[nodiscard]] Key key(const Key& one) const { return one; }
    template <class A, class B>
    bool operator()(const A& a, const B& b) const {
      return key(a).receiver == key(b).receiver && key(a).source == key(b).source;
    }
  };

  const std::vector<Row>& rows_;
  std::unordered_set<std::uint32_t, Hash, Equal> set_;
};

}  // namespace exactff::check
