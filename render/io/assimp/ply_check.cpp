#include "io/assimp/ply_check.hpp"

#include <algorithm>
#include <charconv>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include "base/file_bytes.hpp"
#include "io/vrut/tokenizer.hpp"

namespace vrut::io {

namespace {

constexpr std::size_t kMostHeader = 1 << 20;

struct PlyError {
    std::string what;
};

struct PlyElement {
    std::string line, name;
    std::uint64_t count = 0;
    std::uint64_t least_bytes = 0;  ///< that one of them takes in the file
};

std::uint64_t binary_size(const std::string& type) {
    constexpr std::pair<const char*, std::uint64_t> kSizes[] = {
        {"short", 2}, {"int16", 2},  {"ushort", 2}, {"uint16", 2},  {"int", 4},    {"int32", 4},
        {"uint", 4},  {"uint32", 4}, {"float", 4},  {"float32", 4}, {"double", 8}, {"float64", 8}};
    for (const auto& [name, size] : kSizes)
        if (type == name) return size;
    return 1;
}

/// Lines may end as on Unix, on Windows, and on a Mac of old.
char line_end_of(const std::string& head) {
    const std::size_t first = head.find_first_of("\r\n");
    const bool mac = first + 1 < head.size() && head[first] == '\r' && head[first + 1] != '\n';
    return mac ? '\r' : '\n';
}

class PlyHeader {
public:
    /// Of the beginning of a file.
    explicit PlyHeader(std::string head) {
        const char line_end = line_end_of(head);
        std::istringstream stream(std::move(head));
        std::string line;
        while (std::getline(stream, line, line_end)) {
            const std::uint64_t start = std::exchange(size_, size_ + line.size() + 1);
            ++lines_;
            std::istringstream words(line);
            std::string keyword;
            words >> keyword;
            if (keyword == "end_header") return;
            if (keyword == "format") is_text_ = line.find("ascii") != std::string::npos;
            if (keyword == "element") add_element(words);
            if (keyword == "element" && elements_.back().name == kPlyStrips && elements_.back().count > 0)
                strips_ = start + line.find(kPlyStrips);
            if (strips_ && names_.count("face") > 0)
                throw PlyError{"line " + std::to_string(lines_) +
                               ": 'tristrips' beside 'face' cannot be read: export it with one of them"};
            if (keyword == "property" && !elements_.empty()) add_property(words);
        }
        throw PlyError{"its header has no 'end_header'"};
    }

    /// Throws where the elements do not fit into a file of that size.
    void check(std::uint64_t file_size) const {
        std::uint64_t left =
            file_size - std::min<std::uint64_t>(size_, file_size) + 1;  // a line break at the end
        for (const PlyElement& element : elements_) {
            const std::uint64_t most = left / std::max<std::uint64_t>(element.least_bytes, 1);
            if (element.count > most)
                throw PlyError{"line " + element.line + ": expected a count of '" + excerpt(element.name) +
                               "' that fits into the file, found " + std::to_string(element.count)};
            left -= element.count * element.least_bytes;
        }
    }

    const PlyStripsPlace& strips() const { return strips_; }

private:
    void add_element(std::istream& words) {
        PlyElement& element = elements_.emplace_back();
        element.line = std::to_string(lines_);
        std::string count;
        words >> element.name >> count;
        const char* const end = count.data() + count.size();
        if (const auto [at, error] = std::from_chars(count.data(), end, element.count);
            count.empty() || error != std::errc() || at != end)
            throw PlyError{"line " + element.line + ": expected a count of '" + excerpt(element.name) +
                           "', found '" + excerpt(count) + "'"};
        if (!names_.insert(element.name).second)
            throw PlyError{"line " + element.line + ": expected element '" + excerpt(element.name) +
                           "' once, found it twice"};
    }

    /// In text, a digit and what divides it from the next; of a list, its length.
    void add_property(std::istream& words) {
        std::string type;
        words >> type;
        if (type == "list") words >> type;
        elements_.back().least_bytes += is_text_ ? 2 : binary_size(type);
    }

    std::vector<PlyElement> elements_;
    std::set<std::string> names_;
    std::uint64_t size_ = 0, lines_ = 0;
    bool is_text_ = false;
    PlyStripsPlace strips_;
};

}  // namespace

tl::expected<PlyStripsPlace, std::string> check_ply(const std::filesystem::path& path) try {
    auto file = base::FileReader::open(path);
    if (!file) return tl::unexpected(file.error());
    std::string head(std::min<std::uintmax_t>(file->size(), kMostHeader), '\0');
    if (!file->read(head.data(), head.size())) return tl::unexpected(std::string(base::kCutShort));
    if (head.size() < 3 || (head[0] | 32) != 'p' || (head[1] | 32) != 'l' || (head[2] | 32) != 'y')
        return PlyStripsPlace();
    const PlyHeader header(std::move(head));
    header.check(file->size());
    return header.strips();
} catch (const PlyError& fault) {
    return tl::unexpected(fault.what);
}

}  // namespace vrut::io
