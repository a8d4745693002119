#include "io/osb/geometry.hpp"

#include <array>

#include "io/vrut/tokenizer.hpp"

namespace vrut::io {

namespace {

// Of Geometry::indexMapping: which of a vertex's indices is whose.
constexpr unsigned kMapsPositions = 1, kMapsNormals = 2, kMapsTexcoords = 16;

/// The elements of a multi-value field, still in the file.
struct OsbArray {
    std::string_view type;
    std::size_t at = 0, count = 0, element_size = 1;
    std::string_view bytes;

    OsbCursor element(std::size_t i) const {
        return {bytes.substr(i * element_size, element_size), at + i * element_size};
    }
    std::uint32_t integer(std::size_t i) const {
        return element(i).take_unsigned(static_cast<int>(element_size), "a number");
    }
};

struct ElementType {
    std::string_view type;
    std::size_t size;
};

/// The array that a container holds, whatever its field is called; nothing where it holds none of these
/// types.
std::optional<OsbArray> array_of(const OsbContainer& container, std::span<const ElementType> types) {
    const OsbField* const field = container.find_type("MF");
    if (field == nullptr) return std::nullopt;
    for (const ElementType& known : types) {
        if (field->type != known.type) continue;
        OsbCursor cursor = field->data;
        const std::size_t count = cursor.take_count(known.size, "a count");
        const std::size_t at = cursor.at();
        return OsbArray{known.type, at, count, known.size, cursor.take(count * known.size, "elements")};
    }
    return std::nullopt;
}

constexpr ElementType kIntegers[] = {{"MFUInt32", 4}, {"MFUInt16", 2}, {"MFUInt8", 1}};
constexpr ElementType kPositions[] = {{"MFPnt3f", 12}};
constexpr ElementType kNormals[] = {{"MFVec3f", 12}, {"MFVec3s", 6}, {"MFVec3b", 3}};
constexpr ElementType kTexcoords[] = {{"MFVec2f", 8}};

using IndexTuple = std::array<std::uint32_t, 3>;  // indices of a position, a normal and texture coordinates

/// What stands where in the indices of a vertex; empty for what is not indexed.
struct IndexMapping {
    std::size_t stride = 1;
    std::array<std::optional<std::size_t>, 3> slots{0, 0, 0};  // as Corner's
};

IndexMapping mapping_of(const OsbContainer& container) {
    IndexMapping mapping;
    auto data = container.find("indexMapping");
    const std::size_t count = data ? data->take_count(2, "a count") : 0;
    if (count == 0) return mapping;
    const std::size_t at = data->at();
    mapping = {count, {}};
    for (std::size_t k = 0; k < count; ++k) {
        const std::uint32_t bits = data->take_unsigned(2, "a mapping");
        constexpr unsigned kBits[] = {kMapsPositions, kMapsNormals, kMapsTexcoords};
        for (std::size_t i = 0; i < 3; ++i)
            if ((bits & kBits[i]) != 0 && !mapping.slots[i]) mapping.slots[i] = k;
    }
    if (!mapping.slots[0]) throw OsbError(at, "an index of positions in the mapping", "none");
    return mapping;
}

enum GlPrimitive {
    kTriangles = 4,
    kTriangleStrip = 5,
    kTriangleFan = 6,
    kQuads = 7,
    kQuadStrip = 8,
    kPolygon = 9
};

class OsbGeometryBuilder {
public:
    OsbGeometryBuilder(const OsbFile& file, const OsbContainer& container, ConversionWarnings& warnings,
                       std::size_t& work_left)
        : file_(file), container_(container), warnings_(warnings), work_left_(work_left) {}

    scene::Geometry build() {
        types_ = find("types", kIntegers);
        lengths_ = find("lengths", kIntegers);
        indices_ = find("indices", kIntegers);
        arrays_ = {find("positions", kPositions), find("normals", kNormals), find("texCoords", kTexcoords)};
        report_unsupported_fields();
        if (!types_ || !arrays_[0]) {
            warnings_.add("a geometry without known positions and primitive types is ignored");
            return {};
        }
        mapping_ = mapping_of(container_);
        drop_unmapped();
        add_primitives();
        return std::move(geometry_);
    }

private:
    /// The array of the container that a field points to.
    std::optional<OsbArray> find(std::string_view field, std::span<const ElementType> types) const {
        const OsbContainer* const array = file_.find(container_.pointer(field));
        if (array == nullptr) return std::nullopt;
        return array_of(*array, types);
    }

    void report_unsupported_fields() {
        if (file_.find(container_.pointer("colors")) != nullptr) warnings_.add("vertex colours are ignored");
        if (file_.find(container_.pointer("texCoords1")) != nullptr)
            warnings_.add("a geometry's further texture coordinates are not read");
        for (const char* packed : {"qpositions", "qnormals", "qtexCoords", "pindices"})
            if (container_.find(packed))
                warnings_.add("a geometry's packed '" + std::string(packed) + "' are not read");
    }

    void drop_unmapped() {
        for (std::size_t i = 1; i < 3; ++i)
            if (indices_ && !mapping_.slots[i] && arrays_[i]) {
                warnings_.add("a vertex attribute that the index mapping does not name is ignored");
                arrays_[i].reset();
            }
    }

    void add_primitives() {
        const std::size_t corners = indices_ ? indices_->count / mapping_.stride : arrays_[0]->count;
        std::size_t first = 0;
        if (lengths_ && lengths_->count < types_->count)
            throw OsbError(lengths_->at, std::to_string(types_->count) + " lengths of primitives",
                           std::to_string(lengths_->count));
        for (std::size_t i = 0; i < types_->count; ++i) {
            const std::size_t length = lengths_ ? lengths_->integer(i) : corners - first;
            if (length > corners - first)
                throw OsbError(lengths_->at + i * lengths_->element_size,
                               "a primitive of at most " + std::to_string(corners - first) + " vertices",
                               std::to_string(length));
            work(length + 1);
            add_primitive(types_->integer(i), first, length);
            first += length;
        }
    }

    void work(std::size_t amount) {
        if (amount > work_left_)
            throw OsbError(container_.at, "geometries that have no more vertices than the file has bytes",
                           "more, by arrays that they share");
        work_left_ -= amount;
    }

    void add_primitive(std::uint32_t type, std::size_t first, std::size_t length) {
        if (type < kTriangles)
            return warnings_.add("a primitive of points or lines is ignored: only triangles are supported");
        if (type > kPolygon)
            throw OsbError(types_->at, "types of primitives from 0 to 9", std::to_string(type));
        if (length < 3) return;
        vertices_.clear();
        for (std::size_t i = first; i < first + length; ++i) vertices_.push_back(vertex(i));
        if (type == kTriangles)
            for (std::size_t i = 0; i + 3 <= length; i += 3) triangle(i, i + 1, i + 2);
        else if (type == kQuads)
            for (std::size_t i = 0; i + 4 <= length; i += 4) quad(i, i + 1, i + 2, i + 3);
        else if (type == kQuadStrip)
            for (std::size_t i = 0; i + 4 <= length; i += 2) quad(i, i + 1, i + 3, i + 2);
        else
            for (std::size_t i = 0; i + 3 <= length; ++i)
                if (type == kTriangleStrip)
                    triangle(i + i % 2, i + 1 - i % 2, i + 2);
                else
                    triangle(0, i + 1, i + 2);
    }

    void quad(std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
        triangle(a, b, c);
        triangle(a, c, d);
    }

    /// Of places in vertices_. Strips are joined by triangles without area.
    void triangle(std::size_t i, std::size_t j, std::size_t k) {
        const unsigned a = vertices_[i], b = vertices_[j], c = vertices_[k];
        if (a != b && b != c && c != a) geometry_.triangles.emplace_back(a, b, c);
    }

    unsigned vertex(std::size_t corner) {
        IndexTuple tuple{};
        for (std::size_t i = 0; i < 3; ++i)
            if (arrays_[i]) tuple[i] = index_of(i, corner);
        const auto [found, is_new] = known_.emplace(tuple, static_cast<unsigned>(geometry_.positions.size()));
        if (is_new) add_vertex(tuple);
        return found->second;
    }

    std::uint32_t index_of(std::size_t array, std::size_t corner) const {
        const std::size_t place = indices_ ? corner * mapping_.stride + *mapping_.slots[array] : corner;
        const std::size_t index = indices_ ? indices_->integer(place) : corner;
        if (index >= arrays_[array]->count)
            throw OsbError(indices_ ? indices_->at + place * indices_->element_size : arrays_[array]->at,
                           "an index below " + std::to_string(arrays_[array]->count), std::to_string(index));
        return static_cast<std::uint32_t>(index);
    }

    void add_vertex(const IndexTuple& tuple) {
        geometry_.bounds.add(
            geometry_.positions.emplace_back(arrays_[0]->element(tuple[0]).take_vec3("a coordinate")));
        if (arrays_[1]) geometry_.normals.push_back(normal(tuple[1]));
        if (!arrays_[2]) return;
        OsbCursor cursor = arrays_[2]->element(tuple[2]);
        const double u = cursor.take_real("a texture coordinate"),
                     v = cursor.take_real("a texture coordinate");
        geometry_.texcoords.emplace_back(u, v);
    }

    /// Of any length: whole numbers stay as they are.
    glm::vec3 normal(std::size_t i) const {
        OsbCursor cursor = arrays_[1]->element(i);
        if (arrays_[1]->type == "MFVec3f") return cursor.take_vec3("a normal");
        glm::vec3 value{};
        const int bytes = arrays_[1]->type == "MFVec3s" ? 2 : 1;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t bits = cursor.take_unsigned(bytes, "a normal");
            value[k] = static_cast<float>(bytes == 2 ? static_cast<std::int16_t>(bits)
                                                     : static_cast<std::int8_t>(bits));
        }
        return value;
    }

    const OsbFile& file_;
    const OsbContainer& container_;
    ConversionWarnings& warnings_;
    std::size_t& work_left_;
    std::optional<OsbArray> types_, lengths_, indices_;
    std::array<std::optional<OsbArray>, 3> arrays_;  // positions, normals, texture coordinates
    IndexMapping mapping_;
    scene::Geometry geometry_;
    std::unordered_map<IndexTuple, unsigned, base::SaltedHash> known_;
    std::vector<unsigned> vertices_;  // of the primitive at hand
};

}  // namespace

scene::Index OsbGeometries::take(const OsbContainer& container) {
    if (const auto known = known_containers_.find(container.id); known != known_containers_.end())
        return known->second;
    std::vector<std::uint32_t> arrays;
    for (const char* field : {"types", "lengths", "indices", "positions", "normals", "texCoords"})
        arrays.push_back(container.pointer(field));
    if (const OsbField* mapping = container.find_type("MFUInt16"))
        for (OsbCursor cursor = mapping->data; cursor.left() > 1;)
            arrays.push_back(cursor.take_unsigned(2, "a mapping"));
    const auto [found, is_new] = known_.emplace(std::move(arrays), scene::kNone);
    if (is_new) found->second = add(OsbGeometryBuilder(file_, container, warnings_, work_left_).build());
    return known_containers_[container.id] = found->second;
}

scene::Index OsbGeometries::add(scene::Geometry geometry) {
    if (geometry.triangles.empty()) return scene::kNone;
    geometry.id = static_cast<scene::Id>(all.size());
    all.push_back(std::move(geometry));
    return static_cast<scene::Index>(all.size() - 1);
}

}  // namespace vrut::io
