#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "measure/measure.hpp"

namespace vrut::server::measure {

/// Something measured: what, by which processor, since llvmpipe has one name on all, and what came out.
struct Row {
    std::string chart;  ///< that it was measured for
    std::string scene, sha256, renderer, machine, version, mode;
    int width = 0, height = 0, frames = 0;
    Setting setting;
    std::string method;  ///< where no setting is measured, or of a scene made for it

    Cost cost;
    std::optional<Error> error;
    std::optional<double> wrong;  ///< part of the answers, 0 to 1, that are
};

/// Returns true if it has what its chart shows: errors, of picking the part that is wrong, of times alone
/// neither.
bool is_whole(const Row& row);

/// Fields of a line of comma-separated values (RFC 4180, without line ends in fields); none where a quote is
/// not closed.
std::optional<std::vector<std::string>> fields_of(std::string_view line);
std::string line_of(const std::vector<std::string>& fields);

/// The names of a row's columns, and its text; both without a line end.
std::string header_line();
std::string line_of(const Row& row);
std::optional<Row> row_of(std::string_view line);

/// Rows in a file that grows by a line a row. Where a run was broken off, the next goes on: a last line
/// without an end is dropped, and what is there whole is not measured again.
class Rows {
public:
    /// Throws std::runtime_error where the file cannot be written, or holds something else.
    explicit Rows(const std::filesystem::path& path);

    /// Returns true if what `row` would measure has been.
    bool has(const Row& row) const { return find(row) != nullptr; }
    /// What it was measured to be, or null; until the next add().
    const Row* find(const Row& row) const;
    void add(const Row& row);

private:
    void read(std::string_view text);

    std::filesystem::path path_;
    std::vector<Row> rows_;
    std::map<std::string, std::size_t> places_;  ///< by what was measured
    std::ofstream file_;
};

}  // namespace vrut::server::measure
