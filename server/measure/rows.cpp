#include "measure/rows.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <iterator>
#include <stdexcept>

namespace vrut::server::measure {

namespace {

using Transparency = plan::Methods::Transparency;

constexpr std::array kColumns{
    "chart",          "scene",        "sha256",      "renderer",    "machine",
    "version",        "mode",         "width",       "height",      "frames",
    "scale",          "samples",      "detail",      "light",       "transparency",
    "texture_filter", "jpeg_quality", "subsampling", "clip_planes", "method",  // what is measured ends here
    "triangles",      "ms_mean",      "ms_median",   "ms_p5",       "ms_p95",
    "bytes_mean",     "bytes_median", "bytes_p5",    "bytes_p95",   "flip_mean",
    "flip_median",    "flip_p5",      "flip_p95",    "maximum",     "wrong"};

std::string text_of(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", value);
    return text;
}

std::string one_line(std::string text) {
    for (char& c : text)
        if (static_cast<unsigned char>(c) < ' ' || c == 127) c = ' ';
    return text;
}

const char* name_of(Transparency transparency) {
    switch (transparency) {
        case Transparency::sorted:
            return "sorted";
        case Transparency::per_pixel_lists:
            return "per-pixel lists";
        case Transparency::exact:
            break;
    }
    return "exact";
}

Transparency transparency_of(std::string_view name) {
    for (const Transparency transparency : {Transparency::sorted, Transparency::per_pixel_lists})
        if (name == name_of(transparency)) return transparency;
    return Transparency::exact;
}

std::vector<std::string> key_fields(const Row& row) {
    const Setting& setting = row.setting;
    const bool vertex = setting.methods.light == plan::Methods::Lighting::vertex;
    const bool anisotropic = setting.methods.texture_filter == plan::Methods::TextureFilter::anisotropic;
    return {row.chart,
            one_line(row.scene),
            row.sha256,
            one_line(row.renderer),
            one_line(row.machine),
            row.version,
            row.mode,
            std::to_string(row.width),
            std::to_string(row.height),
            std::to_string(row.frames),
            text_of(setting.scale),
            std::to_string(setting.samples),
            text_of(setting.detail),
            vertex ? "vertex" : "pixel",
            name_of(setting.methods.transparency),
            anisotropic ? "anisotropic" : "trilinear",
            std::to_string(setting.jpeg_quality),
            setting.subsampled ? "4:2:0" : "4:4:4",
            std::to_string(setting.clip_planes),
            row.method};
}

void add_spread(std::vector<std::string>& fields, const Spread& spread) {
    for (const double value : {spread.mean, spread.median, spread.p5, spread.p95})
        fields.push_back(text_of(value));
}

/// Takes fields as numbers, one after the other.
class Numbers {
public:
    explicit Numbers(const std::vector<std::string>& fields, std::size_t first)
        : fields_(fields), next_(first) {}

    template <class Number = double>
    Number take() {
        const std::string& field = fields_[next_++];
        Number number{};
        const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), number);
        good_ = good_ && error == std::errc() && end == field.data() + field.size();
        return number;
    }
    Spread take_spread() {
        Spread spread;
        for (double* value : {&spread.mean, &spread.median, &spread.p5, &spread.p95}) *value = take();
        return spread;
    }
    /// Returns true if the next is empty.
    bool empty() const { return fields_[next_].empty(); }
    void skip(std::size_t count = 1) { next_ += count; }
    bool good() const { return good_; }

private:
    const std::vector<std::string>& fields_;
    std::size_t next_;
    bool good_ = true;
};

std::string key_of(const Row& row) { return line_of(key_fields(row)); }

std::string read_file(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

bool is_whole(const Row& row) {
    if (row.chart == "picking") return row.wrong.has_value();
    constexpr std::array<std::string_view, 4> kTimesAlone{"table-7-1", "sections", "pixels", "triangles"};
    return std::ranges::count(kTimesAlone, row.chart) > 0 || row.error.has_value();
}

std::string line_of(const std::vector<std::string>& fields) {
    std::string line;
    for (std::size_t i = 0; i < fields.size(); ++i) {
        if (i > 0) line += ',';
        if (fields[i].find_first_of(",\"") == std::string::npos) {
            line += fields[i];
            continue;
        }
        line += '"';
        for (const char c : fields[i]) line.append(c == '"' ? 2 : 1, c);
        line += '"';
    }
    return line;
}

std::optional<std::vector<std::string>> fields_of(std::string_view line) {
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const char c = line[i];
        const bool doubled = c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"';
        if (doubled)
            fields.back() += line[++i];
        else if (c == '"')
            quoted = !quoted;
        else if (c == ',' && !quoted)
            fields.emplace_back();
        else
            fields.back() += c;
    }
    if (quoted) return std::nullopt;
    return fields;
}

std::string header_line() { return line_of({kColumns.begin(), kColumns.end()}); }

std::string line_of(const Row& row) {
    std::vector<std::string> fields = key_fields(row);
    fields.push_back(text_of(row.cost.triangles));
    add_spread(fields, row.cost.ms);
    add_spread(fields, row.cost.bytes);
    if (row.error) {
        add_spread(fields, row.error->flip);
        fields.push_back(std::to_string(row.error->maximum));
    } else {
        fields.insert(fields.end(), 5, "");
    }
    fields.push_back(row.wrong ? text_of(*row.wrong) : "");
    return line_of(fields);
}

std::optional<Row> row_of(std::string_view line) {
    const auto fields = fields_of(line);
    if (!fields || fields->size() != kColumns.size()) return std::nullopt;
    Row row;
    std::size_t text = 0;
    for (std::string* member :
         {&row.chart, &row.scene, &row.sha256, &row.renderer, &row.machine, &row.version, &row.mode})
        *member = (*fields)[text++];
    Numbers numbers(*fields, text);
    row.width = numbers.take<int>();
    row.height = numbers.take<int>();
    row.frames = numbers.take<int>();
    row.setting.scale = numbers.take();
    row.setting.samples = numbers.take<int>();
    row.setting.detail = numbers.take();
    if ((*fields)[13] == "vertex") row.setting.methods.light = plan::Methods::Lighting::vertex;
    row.setting.methods.transparency = transparency_of((*fields)[14]);
    if ((*fields)[15] == "anisotropic")
        row.setting.methods.texture_filter = plan::Methods::TextureFilter::anisotropic;
    numbers.skip(3);
    row.setting.jpeg_quality = numbers.take<int>();
    row.setting.subsampled = (*fields)[17] == "4:2:0";
    numbers.skip();
    row.setting.clip_planes = numbers.take<int>();
    row.method = (*fields)[19];
    numbers.skip();
    row.cost.triangles = numbers.take();
    row.cost.ms = numbers.take_spread();
    row.cost.bytes = numbers.take_spread();
    if (numbers.empty()) {
        numbers.skip(5);
    } else {
        row.error.emplace();
        row.error->flip = numbers.take_spread();
        row.error->maximum = numbers.take<int>();
    }
    if (!numbers.empty()) row.wrong = numbers.take();
    if (!numbers.good()) return std::nullopt;
    return row;
}

Rows::Rows(const std::filesystem::path& path) : path_(path) {
    std::string text = std::filesystem::exists(path) ? read_file(path) : std::string();
    const std::size_t end = text.find('\n');
    const std::string head = text.substr(0, end);
    if (end == std::string::npos ? !header_line().starts_with(head) : head != header_line())
        throw std::runtime_error(path.string() +
                                 " holds something else than this program measures: name another --out");
    text.resize(text.rfind('\n') + 1);  // npos + 1: no line has an end
    const bool fresh = text.empty();
    if (!fresh) {
        read(std::string_view(text).substr(text.find('\n') + 1));
        std::filesystem::resize_file(path, text.size());
    }
    file_.open(path, fresh ? std::ios::binary : std::ios::binary | std::ios::app);
    if (fresh) file_ << header_line() << '\n' << std::flush;
    if (!file_) throw std::runtime_error(path.string() + " cannot be written");
}

void Rows::read(std::string_view text) {
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        if (const auto row = row_of(text.substr(0, end));
            row && is_whole(*row) && places_.emplace(key_of(*row), rows_.size()).second)
            rows_.push_back(*row);
        text.remove_prefix(end + 1);
    }
}

const Row* Rows::find(const Row& row) const {
    const auto place = places_.find(key_of(row));
    return place == places_.end() ? nullptr : &rows_[place->second];
}

void Rows::add(const Row& row) {
    places_.emplace(key_of(row), rows_.size());
    rows_.push_back(row);
    file_ << line_of(row) << '\n' << std::flush;
    if (!file_) throw std::runtime_error(path_.string() + " cannot be written");
}

}  // namespace vrut::server::measure
