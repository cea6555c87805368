#include "server/command_line/thesis/printed_tables.h"

#include <array>
#include <cstddef>
#include <sstream>

#include "server/command_line/parse_values.h"

namespace lightwell {

namespace {

constexpr std::array<int, 6> kSamples = {32, 64, 96, 128, 256, 512};
constexpr std::array<int, 3> kIndirectSides_px = {512, 256, 128};
constexpr std::size_t kRowsPerTable = kSamples.size() * kIndirectSides_px.size();
using Figures = std::array<std::array<double, kIndirectSides_px.size()>, kSamples.size()>;

struct Table {
  std::string_view name, scene;
  int triangles;
  Figures frames_per_s;  // by samples, then by the indirect map's side
};

constexpr std::array<Table, 2> kTables = {{{"6.1",
                                            "helicopters",
                                            1522,
                                            {{{11.98, 12.04, 12.05},
                                              {8.16, 8.53, 8.54},
                                              {6.00, 6.39, 6.40},
                                              {4.76, 4.97, 5.01},
                                              {2.63, 2.72, 2.72},
                                              {1.40, 1.43, 1.43}}}},
                                           {"6.2",
                                            "venus",
                                            3284,
                                            {{{8.08, 8.45, 8.53},
                                              {4.61, 4.88, 4.90},
                                              {3.34, 3.47, 3.42},
                                              {2.61, 2.63, 2.63},
                                              {1.37, 1.39, 1.40},
                                              {0.70, 0.71, 0.71}}}}}};

constexpr std::size_t kRows = kTables.size() * kRowsPerTable;

constexpr std::array<PrintedRow, kRows> make_rows() {
  std::array<PrintedRow, kRows> rows;
  std::size_t next = 0;
  for (const Table& table : kTables)
    for (std::size_t i = 0; i < kSamples.size(); ++i)
      for (std::size_t j = 0; j < kIndirectSides_px.size(); ++j, ++next)
        rows[next] = {
            static_cast<int>(next) + 1, table.name, table.scene, table.triangles, kSamples[i], kIndirectSides_px[j],
            table.frames_per_s[i][j]};
  return rows;
}

constexpr std::array<PrintedRow, kRows> kPrintedRows = make_rows();

// "7" or "7:9".
Result<FrameRange> parse_rows(const std::string& text) {
  const std::size_t colon = text.find(':');
  const Result<long long> first = parse_integer(text.substr(0, colon), 1, kRows);
  if (!first) return first.error();
  const Result<long long> last =
      colon == std::string::npos ? first : parse_integer(text.substr(colon + 1), *first, kRows);
  if (!last) return last.error();
  return FrameRange{static_cast<int>(*first), static_cast<int>(*last)};
}

}  // namespace

std::span<const PrintedRow> printed_rows() {
  return kPrintedRows;
}

Result<std::vector<PrintedRow>> select_printed_rows(const std::string& text) {
  if (text == "all") return std::vector<PrintedRow>(kPrintedRows.begin(), kPrintedRows.end());
  if (text == "none") return std::vector<PrintedRow>();
  std::array<bool, kRows> wanted{};
  std::istringstream parts(text + ",");
  for (std::string part; std::getline(parts, part, ',');) {
    const Result<FrameRange> range = parse_rows(part);
    if (!range)
      return invalid_input(
          "", "expected all, none, or rows such as 1,4:6 of 1 to " + std::to_string(kRows) + ", not \"" + text + "\"");
    for (int number = range->first; number <= range->last; ++number)
      wanted[static_cast<std::size_t>(number - 1)] = true;
  }
  std::vector<PrintedRow> rows;
  for (const PrintedRow& row : kPrintedRows)
    if (wanted[static_cast<std::size_t>(row.number - 1)]) rows.push_back(row);
  return rows;
}

}  // namespace lightwell
