#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/salted_hash.hpp"

namespace vrut::io {

/// "at byte N: expected …, found …"; caught by the reader, which knows the file's name.
struct OsbError : std::runtime_error {
    OsbError(std::size_t at, const std::string& expected, const std::string& found);
};

/// Big-endian values one after the other, from bytes that lie `at` in the file. Throws OsbError past the end.
class OsbCursor {
public:
    OsbCursor(std::string_view bytes, std::size_t at) : bytes_(bytes), at_(at) {}

    std::size_t at() const { return at_ + position_; }
    std::size_t left() const { return bytes_.size() - position_; }
    /// `what` names it in the error ("a version").
    std::string_view take(std::size_t count, std::string_view what);
    std::uint32_t take_unsigned(int bytes, std::string_view what);
    /// From -1e15 to 1e15.
    double take_real(std::string_view what);
    glm::dvec3 take_vec3(std::string_view what);
    /// A length with the NUL counted, and so many bytes; the NUL is left out.
    std::string_view take_string(std::string_view what);
    /// A number of things of `bytes_each` bytes each, all of which are left.
    std::size_t take_count(std::size_t bytes_each, std::string_view what);

private:
    std::string_view bytes_;
    std::size_t at_;
    std::size_t position_ = 0;
};

struct OsbField {
    std::string_view name, type;
    OsbCursor data;
};

/// What OpenSG calls a field container: a node, its core, a material, an array of positions …
struct OsbContainer {
    std::string_view type;
    std::uint32_t id = 0;
    std::size_t at = 0;  ///< in the file
    std::span<const OsbField> fields;

    /// A cursor at its beginning; nothing where the container does not have it.
    std::optional<OsbCursor> find(std::string_view field) const;
    const OsbField* find_type(std::string_view beginning) const;

    // A field's single value, or `otherwise` where the container does not have it.
    double real(std::string_view field, double otherwise) const;
    std::int32_t integer(std::string_view field, std::int32_t otherwise) const;
    bool flag(std::string_view field, bool otherwise) const;
    glm::dvec3 vec3(std::string_view field, const glm::dvec3& otherwise) const;
    /// A container's id; 0 for none.
    std::uint32_t pointer(std::string_view field) const;
};

/// The containers of a file in the OpenSG binary format 1.0, all big-endian: a header of "OpenSG binary
/// V1.0", a name, options (strings) and a size (64 bits, unused); then containers: type (string), id (32
/// bits), of all types but Geometry, Image and GenericAtt a kind (8 bits), a version (16 bits), and fields up
/// to an empty string: name, type (strings), size (32 bits) and so many bytes. An empty type ends the file.
/// Views into `bytes`, which must outlive it. Takes at most 16 times the memory of the bytes.
class OsbFile {
public:
    explicit OsbFile(std::string_view bytes);  ///< throws OsbError
    OsbFile(const OsbFile&) = delete;          // its containers refer to its own fields
    OsbFile& operator=(const OsbFile&) = delete;

    std::size_t size() const { return size_; }
    const std::vector<OsbContainer>& containers() const { return containers_; }
    /// null for id 0 and for one that no container has.
    const OsbContainer* find(std::uint32_t id) const;

private:
    struct Extent {
        std::size_t first, count;
    };
    void read_header(OsbCursor& cursor);
    void read_container(OsbCursor& cursor, std::string_view type, std::size_t at);
    void read_fields(OsbCursor& cursor);

    std::size_t size_;
    std::vector<OsbField> fields_;
    std::vector<OsbContainer> containers_;
    std::unordered_map<std::uint32_t, std::size_t, base::SaltedHash> index_of_;
};

/// What a Name that is attached to the container calls it: at most 1,000 bytes of UTF-8; empty without one.
std::string osb_name(const OsbFile& file, const OsbContainer& container);

}  // namespace vrut::io
