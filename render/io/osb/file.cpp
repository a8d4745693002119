#include "io/osb/file.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>

#include "base/utf8.hpp"
#include "io/import_checks.hpp"
#include "io/vrut/tokenizer.hpp"

namespace vrut::io {

namespace {

// Of a container, and attachments looked at: far more than OpenSG's own have, and a search stays short.
constexpr std::size_t kMostFields = 256;

constexpr std::string_view kHeader = "OpenSG binary V1.0";

std::string number_text(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

bool has_kind(std::string_view type) { return type != "Geometry" && type != "Image" && type != "GenericAtt"; }

}  // namespace

OsbError::OsbError(std::size_t at, const std::string& expected, const std::string& found)
    : std::runtime_error("at byte " + std::to_string(at) + ": expected " + expected + ", found " + found) {}

std::string_view OsbCursor::take(std::size_t count, std::string_view what) {
    if (count > left())
        throw OsbError(at(), std::string(what) + " of " + std::to_string(count) + " bytes",
                       std::to_string(left()) + " that are left");
    const std::string_view taken = bytes_.substr(position_, count);
    position_ += count;
    return taken;
}

std::uint32_t OsbCursor::take_unsigned(int bytes, std::string_view what) {
    std::uint32_t value = 0;
    for (const char byte : take(static_cast<std::size_t>(bytes), what))
        value = value << 8 | static_cast<unsigned char>(byte);
    return value;
}

double OsbCursor::take_real(std::string_view what) {
    const std::size_t place = at();
    const double value = std::bit_cast<float>(take_unsigned(4, what));
    if (!(std::abs(value) <= kMaxCoordinate))
        throw OsbError(place, std::string(what) + " from -1e15 to 1e15", number_text(value));
    return value;
}

glm::dvec3 OsbCursor::take_vec3(std::string_view what) {
    glm::dvec3 value{};
    for (int i = 0; i < 3; ++i) value[i] = take_real(what);
    return value;
}

std::string_view OsbCursor::take_string(std::string_view what) {
    const std::string_view text = take(take_unsigned(4, what), what);
    return text.substr(0, text.find('\0'));
}

std::size_t OsbCursor::take_count(std::size_t bytes_each, std::string_view what) {
    const std::size_t place = at();
    const std::size_t count = take_unsigned(4, what), most = left() / bytes_each;
    if (count > most)
        throw OsbError(place, std::string(what) + " of at most " + std::to_string(most),
                       std::to_string(count));
    return count;
}

std::optional<OsbCursor> OsbContainer::find(std::string_view field) const {
    for (const OsbField& own : fields)
        if (own.name == field) return own.data;
    return std::nullopt;
}

const OsbField* OsbContainer::find_type(std::string_view beginning) const {
    for (const OsbField& own : fields)
        if (own.type.starts_with(beginning)) return &own;
    return nullptr;
}

double OsbContainer::real(std::string_view field, double otherwise) const {
    auto data = find(field);
    return data ? data->take_real(field) : otherwise;
}

std::int32_t OsbContainer::integer(std::string_view field, std::int32_t otherwise) const {
    auto data = find(field);
    return data ? static_cast<std::int32_t>(data->take_unsigned(4, field)) : otherwise;
}

bool OsbContainer::flag(std::string_view field, bool otherwise) const {
    auto data = find(field);
    return data ? data->take_unsigned(1, field) != 0 : otherwise;
}

glm::dvec3 OsbContainer::vec3(std::string_view field, const glm::dvec3& otherwise) const {
    auto data = find(field);
    return data ? data->take_vec3(field) : otherwise;
}

std::uint32_t OsbContainer::pointer(std::string_view field) const {
    auto data = find(field);
    return data ? data->take_unsigned(4, field) : 0;
}

OsbFile::OsbFile(std::string_view bytes) : size_(bytes.size()) {
    OsbCursor cursor(bytes, 0);
    read_header(cursor);
    std::vector<Extent> extents;
    while (true) {
        const std::size_t at = cursor.at();
        const std::string_view type = cursor.take_string("a type of container");
        if (type.empty()) break;
        const std::size_t first = fields_.size();
        read_container(cursor, type, at);
        extents.push_back({first, fields_.size() - first});
    }
    for (std::size_t i = 0; i < containers_.size(); ++i)
        containers_[i].fields = std::span(fields_).subspan(extents[i].first, extents[i].count);
}

const OsbContainer* OsbFile::find(std::uint32_t id) const {
    const auto found = index_of_.find(id);
    return found == index_of_.end() ? nullptr : &containers_[found->second];
}

std::string osb_name(const OsbFile& file, const OsbContainer& container) {
    auto attached = container.find("attachments");
    const std::size_t count = attached ? attached->take_count(4, "a count") : 0;
    for (std::size_t i = 0; i < std::min(count, kMostFields); ++i) {
        const OsbContainer* const attachment = file.find(attached->take_unsigned(4, "an id"));
        if (attachment == nullptr || attachment->type != "Name") continue;
        auto text = attachment->find("name");
        if (!text) continue;
        const std::string_view name = text->take_string("a name").substr(0, 1000);
        return std::string(name.substr(0, base::find_invalid_utf8(name)));
    }
    return {};
}

void OsbFile::read_header(OsbCursor& cursor) {
    const std::string expected = "'" + std::string(kHeader) + "'";
    if (cursor.left() < 4 + kHeader.size()) throw OsbError(0, expected, "the file's end");
    OsbCursor length = cursor;
    if (length.take_unsigned(4, expected) > kHeader.size() + 1) throw OsbError(0, expected, "something else");
    if (const std::string_view found = cursor.take_string(expected); found != kHeader)
        throw OsbError(4, expected, "'" + excerpt(found) + "'");
    cursor.take_string("a name");
    cursor.take_string("options");
    cursor.take(8, "a size");
}

void OsbFile::read_container(OsbCursor& cursor, std::string_view type, std::size_t at) {
    const std::size_t id_at = cursor.at();
    const std::uint32_t id = cursor.take_unsigned(4, "an id");
    if (id == 0 || !index_of_.emplace(id, containers_.size()).second)
        throw OsbError(id_at, "an id that no other container has", std::to_string(id));
    // An old GenericAtt has a kind all the same, 4: where others have the version's upper byte, which is 0.
    OsbCursor ahead = cursor;
    if (has_kind(type) || ahead.take_unsigned(1, "a version") == 4) cursor.take(1, "a kind of container");
    cursor.take(2, "a version");
    containers_.push_back({type, id, at, {}});
    read_fields(cursor);
}

void OsbFile::read_fields(OsbCursor& cursor) {
    for (std::size_t count = 0;; ++count) {
        const std::size_t at = cursor.at();
        const std::string_view name = cursor.take_string("a field's name");
        if (name.empty()) return;
        if (count == kMostFields)
            throw OsbError(at, "at most " + std::to_string(kMostFields) + " fields", "one more");
        const std::string_view type = cursor.take_string("a field's type");
        std::size_t size = cursor.take_unsigned(4, "a field's size");
        if (type == "PMFUInt8") size += 4;  // which OpenSG forgets to count
        const std::size_t data_at = cursor.at();
        fields_.push_back(
            {name, type, OsbCursor(cursor.take(size, "field '" + excerpt(name) + "'"), data_at)});
    }
}

}  // namespace vrut::io
