// Tables: what is written is read back to the same bits, in every format; what is damaged or old is refused.
#include "support/test.h"
#include "table/csv.h"
#include "table/fields.h"
#include "text/text_lines.h"

namespace exactff::table {
namespace {

constexpr std::array kExtensions = {".csv", ".npz", ".jsonl"};

class Tables : public testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path path(const std::string& name) const { return directory_.path() / name; }
  [[nodiscard]] std::filesystem::path file(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }

 private:
  const TemporaryDirectory directory_{memory_folder()};
};

// Any bits but those of NaN, which a table does not distinguish; often a special value.
double random_number(std::mt19937_64& random) {
  constexpr std::array kSpecial = {
      0.0, -0.0, 1.0, 0.1, 5e-324, -2.2250738585072014e-308, 1.7976931348623157e308, HUGE_VAL, -HUGE_VAL};
  if (random() % 3 == 0) return kSpecial[random() % kSpecial.size()];
  const double number = std::bit_cast<double>(random());
  return std::isnan(number) ? 0.5 : number;
}

std::string random_text(std::mt19937_64& random) {
  constexpr std::array kParts = {"a", ",", "\"", " ", "'",   "#",   "é", "漢",
                                 "𝄞", "{", "\\", "1", "nan", "yes", ";", "(open)"};
  std::string text;
  for (std::uint64_t i = random() % 5; i > 0; --i) text += kParts[random() % kParts.size()];
  return text;
}

Table random_table(std::mt19937_64& random) {
  Head head;
  head.set("text", random_text(random));
  head.set("count", std::uint64_t{random()});
  head.set("number", random() % 2 == 0 ? 1e-3 : -0.0);
  head.set("flag", random() % 2 == 0);
  head.set("list", std::vector{random_text(random), random_text(random)});
  std::vector<Column> columns;
  for (std::uint64_t i = 0; i <= random() % 6; ++i) {
    columns.push_back({.name = (random() % 2 == 0 ? "c" : "é_") + std::to_string(i),
                       .type = static_cast<Type>(random() % 4),
                       .unit = random_text(random),
                       .strength = static_cast<Strength>(random() % 5),
                       .key = random() % 2 == 0});
  }
  Table table("kind", head, columns);
  std::vector<std::string> texts(columns.size());
  for (std::uint64_t row = random() % 20; row > 0; --row) {
    std::vector<Cell> cells;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      switch (columns[i].type) {
        case Type::kText:
          cells.emplace_back(std::string_view(texts[i] = random_text(random)));
          break;
        case Type::kNumber:
          cells.push_back(random() % 5 == 0 ? Cell() : Cell(random_number(random)));
          break;
        case Type::kCount:
          cells.emplace_back(std::uint64_t{random() >> (random() % 64)});
          break;
        case Type::kFlag:
          cells.emplace_back(random() % 2 == 0);
      }
    }
    table.append(cells);
  }
  return table;
}

void expect_same(const Table& a, const Table& b) {
  EXPECT_EQ(a.kind(), b.kind());
  EXPECT_EQ(a.head(), b.head());
  EXPECT_EQ(a.columns(), b.columns());
  ASSERT_EQ(a.rows(), b.rows());
  for (std::size_t row = 0; row < a.rows(); ++row) {
    for (std::size_t i = 0; i < a.columns().size(); ++i) {
      const Cell one = a.at(row, i), other = b.at(row, i);
      EXPECT_EQ(one, other) << "row " << row << ", column " << i;
      if (const double* const number = std::get_if<double>(&one)) {
        EXPECT_EQ(std::signbit(*number), std::signbit(std::get<double>(other)));
      }
    }
  }
}

TEST_F(Tables, AreReadBackToTheSameBits) {
  for (std::uint64_t i = 0; i < 300; ++i) {
    std::mt19937_64 random(validation::seed_of(i));
    SCOPED_TRACE("seed " + std::to_string(validation::seed_of(i)));
    const Table table = random_table(random);
    for (const char* extension : kExtensions) {
      SCOPED_TRACE(extension);
      write(table, path(std::string("t") + extension));
      EXPECT_EQ(kind_of(path(std::string("t") + extension)), "kind");
      expect_same(table, read(path(std::string("t") + extension)));
      if (HasFailure()) return;
    }
    EXPECT_EQ(csv_text(table), text::read_file(path("t.csv"), "a table"));
  }
}

TEST_F(Tables, HaveAHeadOfOneLineOfJson) {
  Head head;
  head.set("scene", "a\nb\x1b[31m\x80");
  head.set("accuracy", 1e-6);
  const Table table("matrix", head, {{.name = "from", .type = Type::kText, .key = true}});
  EXPECT_EQ(csv_text(table),
            "# {\"exactff\":\"0.1.0\",\"table\":\"matrix\",\"scene\":\"a\\nb\\u001b[31m\\\\x80\",\"accuracy\":1e-06,"
            "\"columns\":[{\"name\":\"from\",\"type\":\"text\",\"strength\":\"given\",\"key\":true}]}\nfrom\n");
  EXPECT_EQ(*parse_csv_head(csv_text(table))->head.number("accuracy"), 1e-6);
}

// A spreadsheet's column is kept, as text.
TEST_F(Tables, KeepUnknownColumns) {
  const Table table("kind", {}, {{.name = "value"}});
  std::string text = csv_text(table);
  text.insert(text.size() - 1, ",remark");
  const Table read_back = read(file("t.csv", text + "0.5,\"so, so\"\n,2\n"));
  ASSERT_EQ(read_back.rows(), 2U);
  EXPECT_EQ(read_back.texts(1), (std::vector<std::string>{"so, so", "2"}));
  EXPECT_EQ(read_back.at(1, 0), Cell());
  EXPECT_EQ(read_back.line_of(1), 4U);
}

TEST_F(Tables, OfOlderVersionsAreRefused) {
  const auto old = file("t.csv", "# exactff 0.1.0 truth: form factors\nreceiver,exact\n1,0.5\n");
  EXPECT_THROW((void)read(old), InputError);
  EXPECT_THROW((void)CsvReader(old, "values"), InputError);
  EXPECT_EQ(kind_of(old), "");
}

// Every prefix, and every changed byte: never a crash, and in an archive, whose arrays have checksums, never wrong
// data.
TEST_F(Tables, ThatAreDamagedAreRefusedOrReadAsTables) {
  std::mt19937_64 random(validation::seed_of(7));
  Table table = random_table(random);
  while (table.rows() < 3) table = random_table(random);
  for (const char* extension : kExtensions) {
    const std::string name = std::string("t") + extension;
    write(table, path(name));
    const std::string bytes = text::read_file(path(name), "a table");
    for (std::size_t i = 0; i < bytes.size(); i += 1 + bytes.size() / 300) {
      for (const bool cut : {true, false}) {
        std::string damaged = cut ? bytes.substr(0, i) : bytes;
        if (!cut) damaged[i] = static_cast<char>(damaged[i] ^ 0x11);
        const auto other = file("damaged" + std::string(extension), damaged);
        try {
          const Table found = read(other);
          if (std::string_view(extension) == ".npz" && !cut && found.rows() > 0) expect_same(table, found);
        } catch (const InputError&) {
        }
      }
    }
  }
}

}  // namespace
}  // namespace exactff::table
