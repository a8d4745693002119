#include "io/gltf/document.hpp"

#include <algorithm>
#include <cassert>
#include <functional>
#include <utility>

#include "base/utf8.hpp"
#include "io/gltf/json_scanner.hpp"
#include "io/vrut/tokenizer.hpp"

namespace vrut::io {

namespace {

// assimp keeps names in 1024 bytes, and puts a number behind.
constexpr std::size_t kLongestMeshName = 900;
// Where the data of an address begins, assimp keeps in a char.
constexpr std::size_t kLongestDataHead = 126;

[[noreturn]] void fail(const std::string& what) { throw JsonError(what); }

std::uint64_t components_of(std::string_view type) {
    constexpr std::pair<std::string_view, std::uint64_t> kTypes[] = {
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
    for (const auto& [name, count] : kTypes)
        if (type == name) return count;
    fail("an accessor's type is invalid");
}

class GltfReader {
public:
    GltfReader(CheckedGltf& result, std::size_t start)
        : result_(result), json_(std::string_view(result.head).substr(start)), scan_(json_) {}

    GltfDocument read() {
        if (base::find_invalid_utf8(json_) != std::string_view::npos) fail("its JSON is not UTF-8");
        const std::pair<std::string_view, void (GltfReader::*)()> parts[] = {
            {"accessors", &GltfReader::read_accessors}, {"bufferViews", &GltfReader::read_views},
            {"buffers", &GltfReader::read_buffers},     {"images", &GltfReader::read_images},
            {"meshes", &GltfReader::read_meshes},       {"nodes", &GltfReader::read_nodes},
            {"scenes", &GltfReader::read_scenes},       {"extensionsUsed", &GltfReader::read_extensions},
            {"cameras", &GltfReader::read_cameras},
        };
        scan_.each_member([&](std::string_view name) {
            if (name == "scene") {
                document_.scene = scan_.take_index();
                return;
            }
            if (name == "skins")
                return skip_with_warning(name, "a skin is ignored: its mesh is shown undeformed");
            if (name == "animations") return skip_with_warning(name, "an animation is ignored");
            for (const auto& [part, read] : parts)
                if (name == part) return (this->*read)();
            scan_.skip();
        });
        return std::move(document_);
    }

private:
    /// A list of parts that are not read.
    void skip_with_warning(std::string_view name, const char* what) {
        hide_member(result_, name);
        scan_.each_element([&](std::size_t) {
            result_.warnings.add(what);
            scan_.skip();
        });
    }

    template <class Part>
    void read_list(std::vector<Part>& list, const std::function<void(Part&, std::string_view)>& member) {
        scan_.each_element([&](std::size_t) {
            Part& part = list.emplace_back();
            scan_.each_member([&](std::string_view name) { member(part, name); });
        });
    }

    void read_buffers() {
        read_list<GltfBuffer>(document_.buffers, [&](GltfBuffer& buffer, std::string_view name) {
            if (name == "byteLength")
                buffer.length = scan_.take_index();
            else if (name == "uri")
                buffer.uri = take_uri();
            else
                scan_.skip();
        });
    }

    /// Of a file, the whole; of data, the beginning.
    std::string take_uri() {
        const std::string_view written = scan_.take_string();
        std::string uri = decoded_string(written, kLongestDataHead + 1);
        const bool data = uri.starts_with("data:");
        if (!data) uri = decoded_string(written);
        require_no_controls(uri);
        if (data && uri.find(',') > kLongestDataHead)
            fail("a data URI has more than " + std::to_string(kLongestDataHead) + " bytes before its data");
        return uri;
    }

    /// assimp marks with them what it has parsed, and ends at a zero.
    static void require_no_controls(std::string_view text) {
        if (std::any_of(text.begin(), text.end(), [](unsigned char c) { return c < ' '; }))
            fail("a URI contains a control character");
    }

    void read_views() {
        read_list<GltfBufferView>(document_.buffer_views, [&](GltfBufferView& view, std::string_view name) {
            if (name == "buffer")
                view.buffer = scan_.take_index();
            else if (name == "byteOffset")
                view.offset = scan_.take_index();
            else if (name == "byteLength")
                view.length = scan_.take_index();
            else if (name == "byteStride")
                view.stride = scan_.take_index();
            else
                scan_.skip();
        });
    }

    void read_accessors() {
        read_list<GltfAccessor>(document_.accessors, [&](GltfAccessor& accessor, std::string_view name) {
            if (name == "bufferView")
                accessor.view = scan_.take_index();
            else if (name == "byteOffset")
                accessor.offset = scan_.take_index();
            else if (name == "componentType")
                accessor.component_type = scan_.take_index();
            else if (name == "count")
                accessor.count = scan_.take_index();
            else if (name == "type")
                accessor.components = components_of(scan_.take_string());
            else if (name == "sparse")
                read_sparse(accessor);
            else
                scan_.skip();
        });
    }

    void read_sparse(GltfAccessor& accessor) {
        accessor.sparse = true;
        scan_.each_member([&](std::string_view part) {
            if (part == "count") {
                accessor.sparse_count = scan_.take_index();
                return;
            }
            const bool values = part == "values";
            scan_.each_member([&](std::string_view name) {
                if (name == "bufferView")
                    (values ? accessor.sparse_values : accessor.sparse_indices) = scan_.take_index();
                else if (name == "byteOffset")
                    (values ? accessor.sparse_values_offset : accessor.sparse_indices_offset) =
                        scan_.take_index();
                else if (name == "componentType")
                    accessor.sparse_component_type = scan_.take_index();
                else
                    scan_.skip();
            });
        });
    }

    void read_images() {
        scan_.each_element([&](std::size_t) {
            scan_.each_member([&](std::string_view name) {
                if (name == "uri") {
                    const std::string uri = take_uri();
                    if (uri.starts_with("data:"))
                        require_mime_type(std::string_view(uri).substr(0, uri.find_first_of(";,")));
                } else if (name == "mimeType") {
                    require_mime_type(decoded_string(scan_.take_string()));
                } else if (name == "bufferView") {
                    document_.image_buffer_views.push_back(scan_.take_index());
                } else {
                    scan_.skip();
                }
            });
        });
    }

    /// assimp looks for what comes after the `/` of an image's kind.
    static void require_mime_type(std::string_view kind) {
        if (kind.substr(0, kind.find('\0')).find('/') == std::string_view::npos)
            fail("an image's mimeType is invalid");
    }

    void read_meshes() {
        scan_.each_element([&](std::size_t) {
            auto& primitives = document_.meshes.emplace_back();
            scan_.each_member([&](std::string_view member) {
                if (member == "primitives")
                    read_list<GltfPrimitive>(primitives,
                                             [&](GltfPrimitive& primitive, std::string_view name) {
                                                 read_primitive(primitive, name);
                                             });
                else if (member == "name" && scan_.take_string().size() > kLongestMeshName)
                    hide_member(result_, member);
                else if (member != "name")
                    scan_.skip();
            });
        });
    }

    void read_primitive(GltfPrimitive& primitive, std::string_view name) {
        if (name == "mode")
            primitive.mode = scan_.take_index();
        else if (name == "indices")
            primitive.indices = scan_.take_index(), primitive.indices_name = name;
        else if (name == "attributes")
            read_attributes(&primitive);
        else if (name == "extensions")
            scan_.each_member([&](std::string_view extension) {
                if (extension != "KHR_draco_mesh_compression") return scan_.skip();
                scan_.each_member([&](std::string_view member) {
                    if (member == "attributes")
                        read_attributes(nullptr);
                    else
                        scan_.skip();
                });
            });
        else if (name == "targets") {
            hide_member(result_, name);
            scan_.skip();
            result_.warnings.add("morph targets are ignored");
        } else
            scan_.skip();
    }

    /// null: of compressed data, whose numbers mean something else.
    void read_attributes(GltfPrimitive* primitive) {
        scan_.each_member([&](std::string_view name) {
            const std::uint32_t accessor = scan_.take_index();
            if (name != "POSITION" && name != "NORMAL" && name != "TEXCOORD_0") {
                if (primitive != nullptr && name.starts_with("COLOR"))
                    result_.warnings.add("vertex colours are ignored");
                if (primitive != nullptr && name.starts_with("TEXCOORD"))
                    result_.warnings.add("a mesh's further texture coordinates are not read");
                return hide_member(result_, name);
            }
            if (primitive == nullptr) return;
            if (name == "POSITION") primitive->positions = accessor;
            if (name == "NORMAL") primitive->normals = accessor;
            if (name == "TEXCOORD_0") primitive->texcoords = accessor, primitive->texcoords_name = name;
        });
    }

    void read_nodes() {
        read_list<GltfNode>(document_.nodes, [&](GltfNode& node, std::string_view name) {
            if (name == "children")
                scan_.each_element([&](std::size_t) { node.children.push_back(scan_.take_index()); });
            else if (name == "mesh")
                node.mesh = scan_.take_index();
            else {
                if (name == "skin") hide_member(result_, name);
                scan_.skip();
            }
        });
    }

    void read_scenes() {
        read_list<std::vector<std::uint32_t>>(
            document_.scenes, [&](std::vector<std::uint32_t>& roots, std::string_view name) {
                if (name == "nodes")
                    scan_.each_element([&](std::size_t) { roots.push_back(scan_.take_index()); });
                else
                    scan_.skip();
            });
    }

    /// assimp derives the horizontal field of view from the vertical one, by another formula in 5.2 than
    /// since 5.3 (its pull request 4886). Without an aspect ratio both leave the file's vertical one as it
    /// is.
    void read_cameras() {
        scan_.each_element([&](std::size_t) {
            scan_.each_member([&](std::string_view kind) {
                if (kind != "perspective") return scan_.skip();
                scan_.each_member([&](std::string_view name) {
                    if (name == "aspectRatio") hide_member(result_, name);
                    scan_.skip();
                });
            });
        });
    }

    void read_extensions() {
        scan_.each_element([&](std::size_t) {
            const std::string_view name = scan_.take_string();
            if (name.find('\\') != std::string_view::npos)
                fail("an extension's name contains the escape character \\");
            if (name == "KHR_lights_punctual" || name == "KHR_materials_pbrSpecularGlossiness" ||
                name == "KHR_draco_mesh_compression")
                return;
            result_.warnings.add("the glTF extension " + excerpt(name) + " is not supported");
            hide_member(result_, name);
        });
    }

    CheckedGltf& result_;
    std::string_view json_;
    JsonScan scan_;
    GltfDocument document_;
};

}  // namespace

void hide_member(CheckedGltf& gltf, std::string_view name) {
    if (name.empty()) return;
    char& first = gltf.head[static_cast<std::size_t>(name.data() - gltf.head.data())];
    assert(first != '\\');  // or what follows would no longer be escaped
    first = '_';
}

GltfDocument read_gltf(CheckedGltf& gltf, std::size_t start) { return GltfReader(gltf, start).read(); }

}  // namespace vrut::io
