#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

/// Writes files in the OpenSG binary format 1.0, as OsbFile reads them: whole ones and hurt ones.
class OsbBuilder {
public:
    static std::string u8(unsigned value) { return {static_cast<char>(value)}; }
    static std::string u16(unsigned value) { return u8(value >> 8) + u8(value & 255); }
    static std::string u32(std::uint32_t value) { return u16(value >> 16) + u16(value & 65535); }
    static std::string f32(float value) { return u32(std::bit_cast<std::uint32_t>(value)); }
    static std::string text(const std::string& value) {
        return u32(static_cast<std::uint32_t>(value.size() + 1)) + value + '\0';
    }
    static std::string reals(const std::vector<float>& values) {
        std::string bytes;
        for (const float value : values) bytes += f32(value);
        return bytes;
    }
    /// A multi-value field's data: a count and the elements.
    static std::string many(const std::vector<std::string>& elements) {
        std::string bytes = u32(static_cast<std::uint32_t>(elements.size()));
        for (const std::string& element : elements) bytes += element;
        return bytes;
    }
    static std::string ids(const std::vector<std::uint32_t>& values) {
        std::vector<std::string> elements;
        for (const std::uint32_t value : values) elements.push_back(u32(value));
        return many(elements);
    }

    struct Field {
        std::string name, type, data;
    };

    OsbBuilder& add(const std::string& type, std::uint32_t id, const std::vector<Field>& fields = {}) {
        bytes_ += text(type) + u32(id);
        if (type != "Geometry" && type != "Image" && type != "GenericAtt") bytes_ += u8(3);
        bytes_ += u16(100);
        for (const auto& [name, field_type, data] : fields)
            bytes_ += text(name) + text(field_type) + u32(static_cast<std::uint32_t>(data.size())) + data;
        bytes_ += text("");
        return *this;
    }
    OsbBuilder& node(std::uint32_t id, std::uint32_t core, const std::vector<std::uint32_t>& children = {}) {
        return add("Node", id,
                   {{"children", "MFNodePtr", ids(children)}, {"core", "SFNodeCorePtr", u32(core)}});
    }
    /// A Geometry `id` with arrays of its own in the containers id + 1 to id + 4, and no material.
    OsbBuilder& geometry(std::uint32_t id, const std::vector<std::pair<unsigned, unsigned>>& primitives,
                         const std::vector<float>& positions, const std::vector<std::uint32_t>& indices) {
        std::vector<std::string> types, lengths, points;
        for (const auto& [type, length] : primitives) {
            types.push_back(u8(type));
            lengths.push_back(u32(length));
        }
        for (std::size_t i = 0; i + 3 <= positions.size(); i += 3)
            points.push_back(reals({positions[i], positions[i + 1], positions[i + 2]}));
        add("Geometry", id,
            {{"types", "SFGeoPTypesPtr", u32(id + 1)},
             {"lengths", "SFGeoPLengthsPtr", u32(id + 2)},
             {"positions", "SFGeoPositionsPtr", u32(id + 3)},
             {"indices", "SFGeoIndicesPtr", u32(id + 4)}});
        add("GeoPTypesUI8", id + 1, {{"types", "MFUInt8", many(types)}});
        add("GeoPLengthsUI32", id + 2, {{"lengths", "MFUInt32", many(lengths)}});
        add("GeoPositions3f", id + 3, {{"positions", "MFPnt3f", many(points)}});
        if (!indices.empty()) add("GeoIndicesUI32", id + 4, {{"indices", "MFUInt32", ids(indices)}});
        return *this;
    }
    OsbBuilder& name(std::uint32_t id, const std::string& value) {
        return add("Name", id, {{"name", "SFString", text(value)}});
    }

    static std::string header() { return text("OpenSG binary V1.0") + text("") + text("") + u32(0) + u32(0); }
    /// The whole file.
    std::string bytes() const { return header() + bytes_ + text(""); }

private:
    std::string bytes_;
};
