#include "io/gltf/check.hpp"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <set>
#include <utility>
#include <vector>

#include "base/file_bytes.hpp"
#include "io/assimp/files.hpp"
#include "io/gltf/document.hpp"
#include "io/gltf/json_scanner.hpp"

namespace vrut::io {

namespace {

// Parents above a node: assimp calls itself for each.
constexpr int kDeepestNode = 1000;
// Of the memory that assimp takes: so many times the files' size, or this.
constexpr std::uint64_t kMostTimes = 64, kAlwaysAllowed = std::uint64_t{256} << 20;
constexpr std::uint32_t kFloat = 5126;

[[noreturn]] void reject(const std::string& what) { throw JsonError(what); }

std::uint64_t component_size(std::uint32_t type) {
    switch (type) {
        case 5120:
        case 5121:
            return 1;
        case 5122:
        case 5123:
            return 2;
        case 5125:
        case kFloat:
            return 4;
        default:
            reject("an accessor's componentType is invalid");
    }
}

class GltfChecker {
public:
    GltfChecker(const std::filesystem::path& path, CheckedGltf& result, GltfDocument document)
        : path_(path), result_(result), document_(std::move(document)) {}

    void check() {
        check_views();
        for (const GltfAccessor& accessor : document_.accessors) check_accessor(accessor);
        check_memory();
        for (auto& mesh : document_.meshes)
            for (GltfPrimitive& primitive : mesh) check_primitive(primitive);
        check_nodes();
    }

private:
    const GltfBufferView& view(std::uint32_t index) const {
        if (index >= document_.buffer_views.size()) reject("there is no bufferView " + std::to_string(index));
        return document_.buffer_views[index];
    }

    void check_views() const {
        for (const GltfBufferView& view : document_.buffer_views) {
            if (view.buffer >= document_.buffers.size() ||
                view.offset + view.length > document_.buffers[view.buffer].length)
                reject("a bufferView exceeds its buffer");
            if (view.stride > 255) reject("a bufferView's byteStride exceeds 252");
        }
    }

    /// Throws where `count` elements of `size` bytes do not lie in the view.
    void check_range(std::uint32_t index, std::uint64_t offset, std::uint64_t count,
                     std::uint64_t size) const {
        const GltfBufferView& in = view(index);
        const std::uint64_t stride = in.stride > 0 ? in.stride : size;
        if (stride < size || (count > 0 && offset + (count - 1) * stride + size > in.length))
            reject("an accessor exceeds its bufferView");
    }

    void check_accessor(const GltfAccessor& accessor) const {
        const std::uint64_t size = component_size(accessor.component_type) * accessor.components;
        if (size == 0) reject("an accessor's type is invalid");
        if (accessor.view) check_range(*accessor.view, accessor.offset, accessor.count, size);
        if (!accessor.sparse) return;
        if (!accessor.sparse_indices || !accessor.sparse_values)
            reject("a sparse accessor lacks its indices or values");
        if (accessor.view && view(*accessor.view).stride > size)
            reject("a sparse accessor over an interleaved bufferView is not supported");
        check_range(*accessor.sparse_indices, accessor.sparse_indices_offset, accessor.sparse_count,
                    component_size(accessor.sparse_component_type));
        check_range(*accessor.sparse_values, accessor.sparse_values_offset, accessor.sparse_count, size);
    }

    const GltfAccessor& accessor(std::uint32_t index) const {
        if (index >= document_.accessors.size()) reject("there is no accessor " + std::to_string(index));
        return document_.accessors[index];
    }

    /// Of what is copied wherever it is named; show() adds the meshes.
    void check_memory() {
        most_memory_ = std::max(kMostTimes * size_of_files(), kAlwaysAllowed);
        for (const GltfBuffer& buffer : document_.buffers) charge_memory(buffer.length);
        for (const std::uint32_t index : document_.image_buffer_views) charge_memory(view(index).length);
        for (const GltfAccessor& accessor : document_.accessors)
            if (accessor.sparse)
                charge_memory(accessor.count * component_size(accessor.component_type) * accessor.components);
    }

    /// The scene's and its buffers', each once, as they lie on the disk: buffers may say anything. At most
    /// 2^50.
    std::uint64_t size_of_files() const {
        const auto folder = path_.parent_path();
        std::set<std::filesystem::path> files = {path_};
        for (const GltfBuffer& buffer : document_.buffers)
            if (!buffer.uri.empty() && !buffer.uri.starts_with("data:"))
                if (const auto file = base::find_below(folder, file_name_of_uri(folder, buffer.uri)))
                    files.insert(*file);
        std::uint64_t total = 0;
        for (const auto& file : files) {
            std::error_code error;
            const std::uintmax_t size = std::filesystem::file_size(file, error);
            constexpr std::uint64_t kMost = std::uint64_t{1} << 50;
            if (!error) total = std::min(total + std::min(size, kMost), kMost);
        }
        return total;
    }

    /// What assimp makes of it: three floats for each vertex, normal and texture coordinate, a face and its
    /// indices for each triangle, line or point.
    std::uint64_t memory_of(const GltfPrimitive& primitive) const {
        const std::uint64_t arrays = 1U + (primitive.normals ? 1U : 0U) + (primitive.texcoords ? 1U : 0U);
        const std::uint64_t drawn = drawn_vertices(primitive);
        return accessor(*primitive.positions).count * arrays * 12 +
               (primitive.mode == 4 ? drawn / 3 : drawn) * 48;
    }

    void charge_memory(std::uint64_t bytes) {
        memory_ += bytes;  // of which each is far below 2^64
        if (memory_ > most_memory_)
            reject("loading it would need more than " + std::to_string(most_memory_ >> 20) +
                   " MiB of memory");
    }

    void check_primitive(GltfPrimitive& primitive) {
        constexpr std::uint32_t kFewest[] = {1, 2, 2, 2, 3, 3, 3};  // by mode
        if (primitive.mode >= std::size(kFewest)) reject("a primitive's mode is invalid");
        if (primitive.mode < 4 && primitive.indices) {  // out of range, those of a loop of lines crash assimp
            hide_member(result_, primitive.indices_name);
            primitive.indices.reset();
        }
        if (!primitive.positions) reject("a primitive has no POSITION attribute");
        const auto has = [&](std::uint32_t index, std::uint64_t components, std::uint32_t component_type) {
            return accessor(index).components == components &&
                   accessor(index).component_type == component_type;
        };
        if (!has(*primitive.positions, 3, kFloat) ||
            (primitive.normals && !has(*primitive.normals, 3, kFloat)))
            reject("a primitive's POSITION or NORMAL accessor is not a VEC3 of floats");
        if (primitive.texcoords && !has(*primitive.texcoords, 2, kFloat)) {
            hide_member(result_, primitive.texcoords_name);  // assimp takes integers for floats
            result_.warnings.add("texture coordinates that are not floats are not read");
        }
        if (primitive.indices && (accessor(*primitive.indices).components != 1 ||
                                  accessor(*primitive.indices).component_type == kFloat))
            reject("a primitive's indices accessor is not a SCALAR of unsigned integers");
        if (accessor(*primitive.positions).count < kFewest[primitive.mode] ||
            drawn_vertices(primitive) < kFewest[primitive.mode])
            reject("a primitive has too few vertices for its mode");
    }

    std::uint64_t drawn_vertices(const GltfPrimitive& primitive) const {
        return accessor(primitive.indices.value_or(*primitive.positions)).count;
    }

    void check_nodes() {
        if (document_.scene >= document_.scenes.size()) reject("it has no scene to show");
        std::vector<bool> reached(document_.nodes.size()), shown(document_.meshes.size());
        const auto reach = [&](std::uint32_t node) {
            if (node >= document_.nodes.size()) reject("there is no node " + std::to_string(node));
            if (reached[node]) reject("node " + std::to_string(node) + " has several parents");
            reached[node] = true;
        };
        std::vector<std::uint32_t> level = document_.scenes[document_.scene], below;
        for (const std::uint32_t node : level) reach(node);
        for (int depth = 0; !level.empty(); ++depth, level.swap(below)) {
            if (depth > kDeepestNode)
                reject("its nodes are nested more than " + std::to_string(kDeepestNode) + " deep");
            below.clear();
            for (const std::uint32_t node : level) {
                if (document_.nodes[node].mesh) show(*document_.nodes[node].mesh, shown);
                for (const std::uint32_t child : document_.nodes[node].children) {
                    reach(child);
                    below.push_back(child);
                }
            }
        }
    }

    void show(std::uint32_t mesh, std::vector<bool>& shown) {
        if (mesh >= document_.meshes.size()) reject("there is no mesh " + std::to_string(mesh));
        if (shown[mesh]) return;
        shown[mesh] = true;
        for (const GltfPrimitive& primitive : document_.meshes[mesh]) {
            const std::uint64_t vertices = drawn_vertices(primitive);
            if (primitive.mode >= 4) result_.triangles += primitive.mode == 4 ? vertices / 3 : vertices - 2;
            charge_memory(memory_of(primitive));
        }
    }

    const std::filesystem::path& path_;
    CheckedGltf& result_;
    GltfDocument document_;
    std::uint64_t memory_ = 0, most_memory_ = 0;
};

constexpr const char* kVersion1 = "it is glTF 1.0: export it as glTF 2.0";
/// Of a file that has nothing to show for version 2, whose lists version 1 has as objects.
bool is_version_1(std::string_view json) try {
    bool found = false;
    JsonScan scan(json);
    scan.each_member([&](std::string_view name) {
        if (name != "asset") return scan.skip();
        scan.each_member([&](std::string_view member) {
            if (member == "version")
                found = scan.take_string().starts_with("1.");
            else
                scan.skip();
        });
    });
    return found;
} catch (const JsonError&) {
    return false;
}

constexpr std::size_t kGlbHeader = 20;  // of the file and its first chunk, which is the JSON

/// Of a binary file, up to the end of its JSON; throws where there is none.
std::string read_glb_head(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    std::string head(kGlbHeader, '\0');
    if (!stream.read(head.data(), kGlbHeader) || !head.starts_with("glTF"))
        reject("it is not a binary glTF (GLB) file");
    if (head.compare(4, 4, std::string("\1\0\0\0", 4)) == 0) reject(kVersion1);
    std::uint32_t length = 0;
    std::memcpy(&length, head.data() + 12, sizeof length);
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (error || length > size - kGlbHeader) reject("its JSON chunk exceeds the file");
    head.resize(kGlbHeader + length);
    if (!stream.read(head.data() + kGlbHeader, length)) reject("it cannot be read to its end");
    return head;
}

std::string read_head(const std::filesystem::path& path, bool binary) {
    if (binary) return read_glb_head(path);
    auto bytes = base::read_bytes(path);
    if (!bytes) reject(bytes.error());
    return *std::move(bytes);
}

}  // namespace

tl::expected<CheckedGltf, std::string> check_gltf(const std::filesystem::path& path) {
    // By its ending, as assimp does.
    const std::string ending = path.extension().string();
    const bool binary = ending.size() == 4;
    CheckedGltf result;
    try {
        result.head = read_head(path, binary);
        GltfChecker(path, result, read_gltf(result, binary ? kGlbHeader : 0)).check();
        return result;
    } catch (const JsonError& fault) {
        const std::size_t start = std::min(binary ? kGlbHeader : 0, result.head.size());
        const bool old = is_version_1(std::string_view(result.head).substr(start));
        return tl::unexpected(std::string(old ? kVersion1 : fault.what()));
    }
}

}  // namespace vrut::io
