#include "io/gltf/binary_chunk.hpp"

#include <bit>
#include <ostream>

#include "base/srgb.hpp"

namespace vrut::io {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");

constexpr int kFloatComponent = 5126, kUnsignedComponent = 5125;  // of an accessor's components
constexpr int kVertices = 34962, kIndices = 34963;                // what a buffer view is for

std::uint64_t aligned(std::uint64_t size) { return (size + 3) / 4 * 4; }

/// Accessors and buffer views, side by side.
class Description {
public:
    explicit Description(JsonWriter& json) : json_(json) {
        json_.open_array("accessors");
        views_.open_array();
    }

    void add(const scene::Geometry& geometry) {
        const std::size_t count = geometry.positions.size(), corners = geometry.triangles.size() * 3;
        open_accessor(kFloatComponent, "VEC3", count, count * 12, kVertices);
        write_range(geometry);
        json_.close();
        if (!geometry.normals.empty()) add_array(kFloatComponent, "VEC3", count, count * 12, kVertices);
        if (!geometry.texcoords.empty()) add_array(kFloatComponent, "VEC2", count, count * 8, kVertices);
        if (!geometry.colors.empty()) add_array(kFloatComponent, "VEC3", count, count * 12, kVertices);
        add_array(kUnsignedComponent, "SCALAR", corners, corners * 4, kIndices);
    }

    JsonWriter& open_view(std::size_t bytes) {
        views_.open_object().number(0, "buffer").number(size_, "byteOffset").number(bytes, "byteLength");
        size_ += aligned(bytes);
        return views_;
    }

    std::uint64_t close() {
        json_.close();
        views_.close();
        json_.raw(views_.text(), "bufferViews");
        json_.open_array("buffers").open_object().number(size_, "byteLength").close().close();
        return size_;
    }

private:
    void add_array(int component, std::string_view type, std::size_t count, std::size_t bytes, int target) {
        open_accessor(component, type, count, bytes, target);
        json_.close();
    }

    void open_accessor(int component, std::string_view type, std::size_t count, std::size_t bytes,
                       int target) {
        open_view(bytes).number(target, "target").close();
        json_.open_object().number(next_view_++, "bufferView").number(component, "componentType");
        json_.number(count, "count").string(type, "type");
    }

    void write_range(const scene::Geometry& geometry) {
        glm::vec3 least(geometry.positions[0]), most = least;
        for (const glm::dvec3& position : geometry.positions) {
            least = glm::min(least, glm::vec3(position));
            most = glm::max(most, glm::vec3(position));
        }
        json_.numbers(&least[0], 3, "min").numbers(&most[0], 3, "max");
    }

    JsonWriter& json_;
    JsonWriter views_;
    std::uint64_t size_ = 0;
    int next_view_ = 0;
};

template <class Rows>
void write_rows(const Rows& rows, std::ostream& out) {
    if (!rows.empty())
        out.write(reinterpret_cast<const char*>(rows.data()),
                  static_cast<std::streamsize>(rows.size() * sizeof rows[0]));
}

void write_geometry(const scene::Geometry& geometry, std::ostream& out) {
    write_rows(std::vector<glm::vec3>(geometry.positions.begin(), geometry.positions.end()), out);
    std::vector<glm::vec3> normals;
    for (const glm::vec3& normal : geometry.normals) {
        const double length = glm::length(glm::dvec3(normal));
        normals.emplace_back(length > 0 ? glm::dvec3(normal) / length : glm::dvec3(0));
    }
    write_rows(normals, out);
    std::vector<glm::vec2> texcoords;  // glTF's v goes downwards
    for (const glm::vec2& texcoord : geometry.texcoords) texcoords.emplace_back(texcoord.x, 1 - texcoord.y);
    write_rows(texcoords, out);
    std::vector<glm::vec3> colors;  // linear in glTF
    for (const glm::vec3& color : geometry.colors)
        colors.emplace_back(base::linear_from_srgb(glm::dvec3(color)));
    write_rows(colors, out);
    write_rows(geometry.triangles, out);
}

}  // namespace

bool GltfBinaryChunk::add(const scene::Geometry& geometry) {
    const auto [found, is_new] = accessors_.emplace(&geometry, Accessors{});
    if (!is_new) return false;
    geometries_.push_back(&geometry);
    found->second.positions = accessor_count_++;
    if (!geometry.normals.empty()) found->second.normals = accessor_count_++;
    if (!geometry.texcoords.empty()) found->second.texcoords = accessor_count_++;
    if (!geometry.colors.empty()) found->second.colors = accessor_count_++;
    found->second.indices = accessor_count_++;
    return true;
}

std::uint64_t GltfBinaryChunk::describe(JsonWriter& json) const {
    if (geometries_.empty()) return 0;  // then there are no images either
    Description description(json);
    for (const scene::Geometry* const geometry : geometries_) description.add(*geometry);
    for (const auto& png : pngs_) description.open_view(png.size()).close();
    return description.close();
}

void GltfBinaryChunk::write(std::ostream& out, const WriteProgress& progress) const {
    std::size_t done = 0;
    for (const scene::Geometry* const geometry : geometries_) {
        write_geometry(*geometry, out);
        if (progress) progress(static_cast<double>(++done) / static_cast<double>(geometries_.size()));
    }
    for (const auto& png : pngs_) {
        out.write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
        out.write("\0\0\0", static_cast<std::streamsize>(aligned(png.size()) - png.size()));
    }
}

}  // namespace vrut::io
