#include "io/vrut/text_reader.hpp"

#include <algorithm>
#include <functional>
#include <span>
#include <thread>
#include <unordered_map>
#include <utility>

#include "base/file_bytes.hpp"
#include "base/salted_hash.hpp"
#include "io/import_checks.hpp"
#include "io/notices.hpp"
#include "io/scene_textures.hpp"
#include "io/vrut/tokenizer.hpp"
#include "scene/texture_coordinates.hpp"

namespace vrut::io {

namespace {

constexpr double kMaxColor = 1e6;
constexpr double kMaxScale = 1e6;

struct NodeKind {
    std::string_view keyword;
    int number;  // VRUT's own; lod and sound are a guess
    scene::NodeType type;
};

constexpr NodeKind kNodeKinds[] = {
    {"assembly", 0, scene::NodeType::assembly}, {"root", 1, scene::NodeType::root},
    {"camera", 2, scene::NodeType::camera},     {"geometry", 3, scene::NodeType::geometry},
    {"light", 4, scene::NodeType::light},       {"lod", 5, scene::NodeType::lod},
    {"switch", 6, scene::NodeType::switch_},    {"background", 7, scene::NodeType::background},
    {"sound", 8, scene::NodeType::sound},
};

struct BlockMember {
    std::string_view name;
    std::function<void()> read;
};

/// Ids that a node's block names, to be looked up when the whole file is read.
struct References {
    scene::Id geometry = -1;  // -1: none given
    scene::Id material = -1;
};

class VrutTextReader {
public:
    VrutTextReader(TextSource source, const std::string& file, unsigned threads)
        : tokens_(std::move(source), threads), file_(file) {}

    scene::SceneParts read() {
        if (tokens_.peek().kind != Token::Kind::word || tokens_.peek().text() != "vrut-text")
            tokens_.fail_expected("'vrut-text 1'");
        tokens_.take();
        if (tokens_.peek().kind != Token::Kind::number || tokens_.peek().number != 1)
            tokens_.fail_expected("version 1 of vrut-text");
        tokens_.take();
        while (tokens_.peek().kind != Token::Kind::end_of_file) read_block();
        resolve_references();
        notices_.append_to(parts_.notices);
        parts_.name = std::filesystem::path(file_).stem().string();
        return std::move(parts_);
    }

private:
    void read_block() {
        const std::size_t line = tokens_.line();
        const std::string_view keyword = tokens_.take_word("'unit', 'material', 'geometry' or 'node'");
        if (keyword == "unit")
            parts_.unit = tokens_.take_number("metres per unit", 1e-12, 1e12);
        else if (keyword == "material")
            read_material(line);
        else if (keyword == "geometry")
            read_geometry(line);
        else if (keyword == "node")
            read_node(line);
        else
            throw ParseError(
                line, "expected 'unit', 'material', 'geometry' or 'node', found '" + excerpt(keyword) + "'");
    }

    // --- members

    void read_members(const std::string& block, std::span<const BlockMember> members) {
        std::vector<const BlockMember*> seen;
        for (;;) {
            const std::size_t line = tokens_.line();
            const std::string_view name = tokens_.take_word("a member of " + block + " or 'end'");
            if (name == "end") return;
            const auto member = find(members, name);
            if (member == members.end()) {
                skip_unknown(block, line, name, members);
                continue;
            }
            if (std::find(seen.begin(), seen.end(), &*member) != seen.end())
                throw ParseError(
                    line, "expected '" + std::string(name) + "' once in " + block + ", found it twice");
            seen.push_back(&*member);
            member->read();
        }
    }

    static std::span<const BlockMember>::iterator find(std::span<const BlockMember> members,
                                                       std::string_view name) {
        return std::find_if(members.begin(), members.end(),
                            [&](const BlockMember& m) { return m.name == name; });
    }

    void skip_unknown(const std::string& block, std::size_t line, std::string_view name,
                      std::span<const BlockMember> members) {
        notice(line, "member '" + excerpt(name) + "' of " + block + " is unknown and was skipped");
        for (;;) {
            const Token& token = tokens_.peek();
            if (token.kind == Token::Kind::end_of_file) tokens_.fail_expected("'end' of " + block);
            if (token.kind == Token::Kind::word &&
                (token.text() == "end" || find(members, token.text()) != members.end()))
                return;
            tokens_.take();
        }
    }

    void notice(std::size_t line, const std::string& what) {
        notices_.add(file_ + ":" + std::to_string(line) + ": " + what);
    }

    glm::dvec4 take_color(std::string_view what) {
        glm::dvec4 color;
        for (int i = 0; i < 3; ++i) color[i] = tokens_.take_number(what, 0, kMaxColor);
        color.a = tokens_.take_number(std::string(what) + "'s alpha", 0, 1);
        return color;
    }

    glm::dvec3 take_point(std::string_view what) {
        glm::dvec3 point;
        for (int i = 0; i < 3; ++i) point[i] = tokens_.take_number(what, -kMaxCoordinate, kMaxCoordinate);
        return point;
    }

    scene::Id take_id(std::string_view what) { return tokens_.take_integer(what, 0, scene::kMaxId); }

    template <class Ids>
    void remember(Ids& ids, scene::Id id, std::size_t index, std::size_t line, const char* kind) {
        if (!ids.emplace(id, static_cast<scene::Index>(index)).second)
            throw ParseError(
                line, std::string("expected each ") + kind + " once, found " + std::to_string(id) + " twice");
    }

    // --- blocks

    static scene::MetallicRoughness& metallic_roughness(scene::Material& material) {
        if (!material.metallic_roughness) material.metallic_roughness.emplace();
        return *material.metallic_roughness;
    }

    scene::Wrap take_wrap() {
        const std::size_t line = tokens_.line();
        const std::string_view word = tokens_.take_word("repeat, mirror or clamp");
        for (const scene::Wrap wrap : {scene::Wrap::repeat, scene::Wrap::mirror, scene::Wrap::clamp})
            if (word == name_of(wrap)) return wrap;
        throw ParseError(line, "expected repeat, mirror or clamp, found '" + excerpt(word) + "'");
    }

    scene::Magnification take_magnification() {
        const std::size_t line = tokens_.line();
        const std::string_view word = tokens_.take_word("linear or nearest");
        for (const auto magnification : {scene::Magnification::linear, scene::Magnification::nearest})
            if (word == name_of(magnification)) return magnification;
        throw ParseError(line, "expected linear or nearest, found '" + excerpt(word) + "'");
    }

    void read_material(std::size_t line) {
        scene::Material material;
        material.id = take_id("the material's id");
        material.name = tokens_.take_string("the material's name");
        const BlockMember members[] = {
            {"ambient", [&] { material.ambient = take_color("ambient"); }},
            {"diffuse", [&] { material.diffuse = take_color("diffuse"); }},
            {"specular", [&] { material.specular = take_color("specular"); }},
            {"emission", [&] { material.emission = take_color("emission"); }},
            {"shininess", [&] { material.shininess = tokens_.take_number("shininess", 0, 10000); }},
            {"reflectivity", [&] { material.reflectivity = tokens_.take_number("reflectivity", 0, 1); }},
            {"two-sided", [&] { material.two_sided = tokens_.take_flag("two-sided"); }},
            {"emissive",
             [&] {
                 for (int i = 0; i < 3; ++i)
                     material.emissive[i] = tokens_.take_number("emissive", 0, kMaxColor);
             }},
            {"emissive-image",
             [&] { material.emissive_image = tokens_.take_string("the emissive image's file"); }},
            {"image", [&] { material.image = tokens_.take_string("the image's file"); }},
            {"image-wrap",
             [&] {
                 for (scene::Wrap& wrap : material.sampler.wraps) wrap = take_wrap();
             }},
            {"image-magnification", [&] { material.sampler.magnification = take_magnification(); }},
            {"metallic-roughness",
             [&] {
                 metallic_roughness(material).metallic = tokens_.take_number("metallic", 0, 1);
                 metallic_roughness(material).roughness = tokens_.take_number("roughness", 0, 1);
             }},
            {"clear-coat",
             [&] { metallic_roughness(material).clear_coat = tokens_.take_number("clear-coat", 0, 1); }},
            {"occlusion-roughness-metallic-image",
             [&] {
                 material.occlusion_roughness_metallic_image =
                     tokens_.take_string("the occlusion, roughness and metallic image's file");
             }},
            {"normal-image", [&] { material.normal_image = tokens_.take_string("the normal image's file"); }},
            {"normal-scale",
             [&] { material.normal_scale = tokens_.take_number("normal-scale", -kMaxScale, kMaxScale); }},
        };
        read_members("material " + std::to_string(material.id), members);
        remember(material_ids_, material.id, parts_.materials.size(), line, "material");
        parts_.materials.push_back(std::move(material));
    }

    scene::TexcoordsNearZero take_texcoords() {
        std::vector<glm::dvec2> texcoords(tokens_.take_count("a count of texture coordinates", 4));
        for (glm::dvec2& texcoord : texcoords)
            for (int i = 0; i < 2; ++i)
                texcoord[i] = tokens_.take_number("a texture coordinate", -kMaxCoordinate, kMaxCoordinate);
        return scene::texcoords_near_zero(texcoords);
    }

    std::vector<glm::vec3> take_vertex_colors() {
        std::vector<glm::vec3> colors(tokens_.take_count("a count of colours", 6));
        for (glm::vec3& color : colors)
            for (int i = 0; i < 3; ++i) color[i] = static_cast<float>(tokens_.take_number("a colour", 0, 1));
        return colors;
    }

    void read_geometry(std::size_t line) {
        scene::Geometry geometry;
        geometry.id = take_id("the geometry's id");
        scene::TexcoordsNearZero texcoords;
        std::size_t normals_line = 0, texcoords_line = 0, colors_line = 0, triangles_line = 0;
        const BlockMember members[] = {
            {"vertices",
             [&] {
                 geometry.positions.resize(tokens_.take_count("a count of vertices", 6));
                 for (glm::dvec3& position : geometry.positions) position = take_point("a vertex coordinate");
             }},
            {"normals",
             [&] {
                 normals_line = tokens_.line();
                 geometry.normals.resize(tokens_.take_count("a count of normals", 6));
                 for (glm::vec3& normal : geometry.normals)
                     normal = glm::vec3(take_point("a normal's coordinate"));
             }},
            {"texcoords",
             [&] {
                 texcoords_line = tokens_.line();
                 texcoords = take_texcoords();
             }},
            {"colors",
             [&] {
                 colors_line = tokens_.line();
                 geometry.colors = take_vertex_colors();
             }},
            {"triangles",
             [&] {
                 triangles_line = tokens_.line();
                 geometry.triangles.resize(tokens_.take_count("a count of triangles", 6));
                 for (glm::uvec3& triangle : geometry.triangles)
                     for (int i = 0; i < 3; ++i)
                         triangle[i] = static_cast<unsigned>(
                             tokens_.take_integer("a vertex index", 0, (std::int64_t{1} << 32) - 1));
             }},
        };
        read_members("geometry " + std::to_string(geometry.id), members);
        geometry.texcoords = std::move(texcoords.texcoords);

        const std::size_t count = geometry.positions.size();
        const auto check_count = [&](std::size_t found, std::size_t at, const char* what) {
            if (found != 0 && found != count)
                throw ParseError(at, "expected as many " + std::string(what) + " as vertices (" +
                                         std::to_string(count) + "), found " + std::to_string(found));
        };
        check_count(geometry.normals.size(), normals_line, "normals");
        check_count(geometry.texcoords.size(), texcoords_line, "texture coordinates");
        check_count(geometry.colors.size(), colors_line, "colours");
        for (const glm::uvec3& triangle : geometry.triangles)
            if (const unsigned highest = std::max({triangle.x, triangle.y, triangle.z}); highest >= count)
                throw ParseError(triangles_line, "expected vertex indices below " + std::to_string(count) +
                                                     " in geometry " + std::to_string(geometry.id) +
                                                     ", found " + std::to_string(highest));
        for (const glm::dvec3& position : geometry.positions) geometry.bounds.add(position);
        remember(geometry_ids_, geometry.id, parts_.geometries.size(), line, "geometry");
        parts_.geometries.push_back(std::move(geometry));
        taken_off_.push_back(texcoords.taken_off);
    }

    scene::NodeType take_node_type() {
        const Token& token = tokens_.peek();
        for (const NodeKind& kind : kNodeKinds) {
            const bool by_word = token.kind == Token::Kind::word && token.text() == kind.keyword;
            const bool by_number = token.kind == Token::Kind::number && token.number == kind.number;
            if (by_word || by_number) {
                tokens_.take();
                return kind.type;
            }
        }
        tokens_.fail_expected(
            "a node type (assembly, root, camera, geometry, light, lod, switch, background, sound)");
    }

    void read_node(std::size_t line) {
        scene::SceneParts::PartNode part;
        References references;
        part.line = line;
        scene::Node& node = part.node;
        node.id = take_id("the node's id");
        node.name = tokens_.take_string("the node's name");
        node.type = take_node_type();

        std::vector<BlockMember> members = {
            {"parent", [&] { part.parent_id = take_id("the parent's id"); }},
            {"active", [&] { node.active = tokens_.take_flag("active"); }},
            {"matrix", [&] { read_matrix(node.matrix); }},
        };
        if (node.type == scene::NodeType::assembly || node.type == scene::NodeType::geometry) {
            members.push_back({"hinge", [&] { read_hinge(node.hinge.emplace()); }});
            members.push_back(
                {"presentation", [&] { node.presentation = tokens_.take_flag("presentation"); }});
        }
        add_members_of_type(node, references, members);
        read_members("node " + std::to_string(node.id), members);
        if (node.type == scene::NodeType::sound)
            notice(line, "node " + std::to_string(node.id) + " is a sound and was kept as a group");
        parts_.nodes.push_back(std::move(part));
        references_.push_back(references);
    }

    void read_matrix(glm::dmat4& matrix) {
        std::size_t line = 0;
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 4; ++column) {
                line = tokens_.line();
                matrix[column][row] =
                    tokens_.take_number("a matrix element", -kMaxCoordinate, kMaxCoordinate);
            }
        if (matrix[0][3] != 0 || matrix[1][3] != 0 || matrix[2][3] != 0 || matrix[3][3] != 1)
            throw ParseError(line, "expected 0 0 0 1 as the matrix's last row, found another");
    }

    void read_hinge(scene::Hinge& hinge) {
        const std::size_t line = tokens_.line();
        hinge.axis = take_point("the hinge's axis");
        if (hinge.axis == glm::dvec3(0))
            throw ParseError(line, "expected a hinge's axis that is not zero, found 0 0 0");
        hinge.degrees = tokens_.take_number("the hinge's degrees", -360, 360);
    }

    void add_camera_members(scene::CameraData& camera, std::vector<BlockMember>& members) {
        members.push_back({"eye", [&] { camera.eye = take_point("the eye"); }});
        members.push_back({"focus", [&] { camera.focus = take_point("the focus"); }});
        members.push_back({"up", [&] { camera.up = take_point("up"); }});
        members.push_back({"fov", [&] { camera.fov = tokens_.take_number("fov", 1, 170); }});
        members.push_back({"look", [&] {
                               camera.look_radius =
                                   tokens_.take_number("the radius of looking around", 0, kMaxCoordinate);
                           }});
    }

    void add_members_of_type(scene::Node& node, References& references, std::vector<BlockMember>& members) {
        const auto material = [&] { references.material = take_id("the material's id"); };
        switch (node.type) {
            case scene::NodeType::geometry:
                node.data = scene::GeometryData{};
                members.push_back({"geometry", [&] { references.geometry = take_id("the geometry's id"); }});
                members.push_back({"material", material});
                break;
            case scene::NodeType::camera:
                add_camera_members(node.data.emplace<scene::CameraData>(), members);
                break;
            case scene::NodeType::light: {
                auto& light = node.data.emplace<scene::LightData>();
                members.push_back({"type", [&] { light.type = take_light_type(); }});
                members.push_back({"color", [&] { light.color = take_color("color"); }});
                members.push_back({"attenuation", [&] {
                                       for (int i = 0; i < 3; ++i)
                                           light.attenuation[i] =
                                               tokens_.take_number("attenuation", 0, kMaxCoordinate);
                                   }});
                members.push_back({"angle", [&] { light.angle = tokens_.take_number("angle", 0, 180); }});
                break;
            }
            case scene::NodeType::switch_: {
                auto& data = node.data.emplace<scene::SwitchData>();
                members.push_back({"active-child", [&] {
                                       data.active_child = static_cast<int>(
                                           tokens_.take_integer("active-child", -2, 1 << 30));
                                   }});
                break;
            }
            case scene::NodeType::lod: {
                auto& data = node.data.emplace<scene::LodData>();
                members.push_back({"ranges", [&] {
                                       while (tokens_.peek().kind == Token::Kind::number)
                                           data.ranges.push_back(
                                               tokens_.take_number("a range", 0, kMaxCoordinate));
                                   }});
                break;
            }
            case scene::NodeType::background: {
                auto& data = node.data.emplace<scene::BackgroundData>();
                members.push_back({"material", material});
                members.push_back({"cube-map", [&] {
                                       auto& faces = data.cube_map.emplace();
                                       for (std::string& face : faces)
                                           face = tokens_.take_string("a cube map's image");
                                   }});
                members.push_back(
                    {"only-reflected", [&] { data.only_reflected = tokens_.take_flag("only-reflected"); }});
                break;
            }
            case scene::NodeType::assembly:
            case scene::NodeType::root:
            case scene::NodeType::sound:
                break;
        }
    }

    scene::LightData::Type take_light_type() {
        const std::size_t line = tokens_.line();
        const std::string_view word = tokens_.take_word("point, directional or spot");
        if (word == "point") return scene::LightData::Type::point;
        if (word == "directional") return scene::LightData::Type::directional;
        if (word == "spot") return scene::LightData::Type::spot;
        throw ParseError(line, "expected point, directional or spot, found '" + excerpt(word) + "'");
    }

    // --- after the last block

    template <class Ids>
    static scene::Index look_up(const Ids& ids, scene::Id id, std::size_t line, scene::Id node,
                                const char* kind) {
        if (id < 0) return scene::kNone;
        const auto found = ids.find(id);
        if (found == ids.end())
            throw ParseError(line, "expected " + std::string(kind) + " " + std::to_string(id) + " of node " +
                                       std::to_string(node) + " in the file, found none");
        return found->second;
    }

    void resolve_references() {
        for (std::size_t i = 0; i < references_.size(); ++i) {
            auto& [node, parent_id, line] = parts_.nodes[i];
            const References& ids = references_[i];
            const scene::Index material = look_up(material_ids_, ids.material, line, node.id, "material");
            if (auto* data = std::get_if<scene::GeometryData>(&node.data)) {
                data->geometry = look_up(geometry_ids_, ids.geometry, line, node.id, "geometry");
                data->material = material;
                put_back_where_needed(*data);
            } else if (auto* background = std::get_if<scene::BackgroundData>(&node.data)) {
                background->material = material;
            }
        }
    }

    /// Of textures that do not repeat, whole numbers make a difference.
    void put_back_where_needed(const scene::GeometryData& data) {
        if (data.geometry == scene::kNone || data.material == scene::kNone ||
            parts_.materials[static_cast<std::size_t>(data.material)].sampler.repeats())
            return;
        const auto geometry = static_cast<std::size_t>(data.geometry);
        const glm::dvec2 taken_off = std::exchange(taken_off_[geometry], glm::dvec2(0));
        for (int axis = 0; axis < 2; ++axis)
            if (taken_off[axis] != 0)
                for (glm::vec2& texcoord : parts_.geometries[geometry].texcoords)
                    texcoord[axis] = static_cast<float>(double{texcoord[axis]} + taken_off[axis]);
    }

    Tokenizer tokens_;
    const std::string& file_;
    scene::SceneParts parts_;
    std::vector<References> references_;  // one for each of parts_.nodes
    std::vector<glm::dvec2> taken_off_;   // of the texture coordinates of each of parts_.geometries
    std::unordered_map<scene::Id, scene::Index, base::SaltedHash> material_ids_, geometry_ids_;
    Notices notices_;
};

// More would wait for the one that takes the tokens.
unsigned reading_threads() { return std::min(std::thread::hardware_concurrency(), 8U); }

/// Thrown where a file ends before its size.
struct CutShort {};

TextSource source_of(std::string_view text) {
    return {text.size(), [text](char* to, std::size_t count) mutable {
                text.copy(to, count);
                text.remove_prefix(count);
            }};
}

TextSource source_of(base::FileReader& file) {
    return {static_cast<std::size_t>(file.size()), [&file](char* to, std::size_t count) {
                if (!file.read(to, count)) throw CutShort();
            }};
}

/// Which tells how much of it was handed out.
TextSource with_progress(TextSource source, const ReadProgress& progress) {
    if (!progress) return source;
    return {source.size, [source, progress, done = std::size_t{0}](char* to, std::size_t count) mutable {
                progress(static_cast<double>(done) / static_cast<double>(source.size));
                source.read(to, count);
                done += count;
            }};
}

PartsResult parse_parts(const TextSource& source, const std::string& file, const ReadProgress& progress,
                        unsigned threads) {
    try {
        return VrutTextReader(with_progress(source, progress), file, threads).read();
    } catch (const ParseError& error) {
        return tl::unexpected(file + ":" + std::to_string(error.line) + ": " + error.what());
    }
}

}  // namespace

PartsResult read_vrut_parts(std::string_view text, const std::string& file, const ReadProgress& progress,
                            unsigned threads) {
    return parse_parts(source_of(text), file, progress, threads > 0 ? threads : reading_threads());
}

PartsResult read_vrut_file(const std::filesystem::path& path, const ReadProgress& progress,
                           const ReadOptions& options) try {
    const std::string file = path.string();
    auto reader = base::FileReader::open(path);
    if (!reader) return tl::unexpected(file + ": " + reader.error());
    auto parts = parse_parts(source_of(*reader), file, progress, reading_threads());
    if (parts) read_textures(*parts, path, progress, options.texture_folders);
    return parts;
} catch (const CutShort&) {
    return tl::unexpected(path.string() + ": " + std::string(base::kCutShort));
}

ReadResult read_vrut_text(std::string_view text, const std::string& file, const ReadProgress& progress) {
    auto parts = read_vrut_parts(text, file, progress);
    if (!parts) return tl::unexpected(parts.error());
    return build_scene(*std::move(parts), file);
}

}  // namespace vrut::io
