#include "io/osb/scene.hpp"

#include <algorithm>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtx/transform.hpp>
#include <map>

#include "base/file_bytes.hpp"
#include "io/notices.hpp"
#include "io/osb/geometry.hpp"
#include "io/osb/materials.hpp"
#include "io/scene_textures.hpp"
#include "io/vrut/tokenizer.hpp"

namespace vrut::io {

namespace {

constexpr std::string_view kKnownTypes[] = {"Node",
                                            "Group",
                                            "Geometry",
                                            "Transform",
                                            "ComponentTransform",
                                            "Switch",
                                            "DistanceLOD",
                                            "MaterialGroup",
                                            "PointLight",
                                            "DirectionalLight",
                                            "SpotLight",
                                            "Name",
                                            "SimpleMaterial",
                                            "ChunkMaterial",
                                            "SimpleTexturedMaterial",
                                            "MaterialChunk",
                                            "PolygonChunk",
                                            "TextureChunk",
                                            "Image",
                                            "GeoPositions3f",
                                            "GeoNormals3f",
                                            "GeoNormals3s",
                                            "GeoNormals3b",
                                            "GeoTexCoords2f",
                                            "GeoIndicesUI32",
                                            "GeoIndicesUI16",
                                            "GeoPLengthsUI32",
                                            "GeoPLengthsUI16",
                                            "GeoPLengthsUI8",
                                            "GeoPTypesUI32",
                                            "GeoPTypesUI16",
                                            "GeoPTypesUI8"};

glm::dmat4 rotation(const OsbContainer& from, std::string_view field) {
    auto data = from.find(field);
    if (!data) return glm::dmat4(1);
    const glm::dvec3 axis = data->take_vec3("a rotation");
    const glm::dquat turn(data->take_real("a rotation"), axis);
    return glm::length(turn) > 0 ? glm::mat4_cast(glm::normalize(turn)) : glm::dmat4(1);
}

/// The matrix of a ComponentTransform: about its centre, scaled along turned axes, turned, moved.
glm::dmat4 composed_matrix(const OsbContainer& core) {
    const glm::dmat4 center = glm::translate(core.vec3("center", {}));
    const glm::dmat4 scale_axes = rotation(core, "scaleOrientation");
    return glm::translate(core.vec3("translation", {})) * center * rotation(core, "rotation") * scale_axes *
           glm::scale(core.vec3("scale", glm::dvec3(1))) * glm::transpose(scale_axes) * glm::inverse(center);
}

glm::dmat4 stored_matrix(const OsbContainer& core) {
    glm::dmat4 matrix(1);
    if (auto data = core.find("matrix"))
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row) matrix[column][row] = data->take_real("a matrix element");
    return matrix;
}

glm::dmat4 matrix_of(const OsbContainer& core) {
    const glm::dmat4 matrix = core.type == "Transform" ? stored_matrix(core) : composed_matrix(core);
    for (int column = 0; column < 4; ++column) {
        if (matrix[column][3] != (column == 3 ? 1 : 0))
            throw OsbError(core.at, "a matrix whose last row is 0 0 0 1", "another one");
        for (int row = 0; row < 3; ++row)
            if (!(std::abs(matrix[column][row]) <= 1e15))
                throw OsbError(core.at, "matrix elements from -1e15 to 1e15", "others");
    }
    return matrix;
}

/// Turned so that z points along a direction.
glm::dmat4 frame_along(const glm::dvec3& direction) {
    const double length = glm::length(direction);
    const glm::dvec3 z = length > 0 ? direction / length : glm::dvec3(0, 0, 1);
    const glm::dvec3 x =
        glm::normalize(glm::cross(std::abs(z.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0), z));
    return glm::dmat4(glm::dmat3(x, glm::cross(z, x), z));
}

bool is_light(std::string_view type) {
    return type == "PointLight" || type == "DirectionalLight" || type == "SpotLight";
}

scene::Node light_of(const OsbContainer& core) {
    scene::Node node;
    node.name = "light";
    node.type = scene::NodeType::light;
    node.active = core.flag("on", true);
    auto& light = node.data.emplace<scene::LightData>();
    light.color = glm::dvec4(glm::clamp(core.vec3("diffuse", glm::dvec3(1)), 0.0, 1e6), 1);
    light.attenuation = {core.real("constantAttenuation", 1), core.real("linearAttenuation", 0),
                         core.real("quadraticAttenuation", 0)};
    light.attenuation = glm::max(light.attenuation, 0.0);
    const glm::dvec3 direction = core.vec3("direction", {0, 0, 1});
    if (core.type == "DirectionalLight") {
        light.type = scene::LightData::Type::directional;
        node.matrix = frame_along(direction);  // towards the light
        return node;
    }
    node.matrix = glm::translate(core.vec3("position", {}));
    if (core.type != "SpotLight") return node;
    light.type = scene::LightData::Type::spot;
    light.angle = std::clamp(2 * glm::degrees(core.real("spotCutOff", 0)), 0.0, 180.0);
    node.matrix = node.matrix * frame_along(-direction);
    return node;
}

class OsbReader {
public:
    OsbReader(std::string_view bytes, std::string file, const ReadProgress& progress)
        : file_name_(std::move(file)), progress_(progress), file_(bytes) {}

    scene::SceneParts read() {
        parts_.name = std::filesystem::path(file_name_).stem().string();
        if (!file_.containers().empty()) read_nodes();
        add_lights();
        parts_.geometries = std::move(geometries_.all);
        parts_.materials = std::move(materials_.all);
        parts_.textures = std::move(materials_.textures);
        warnings_.append_to(parts_.notices, file_name_);
        report_skipped();
        return std::move(parts_);
    }

private:
    struct OsbPendingNode {
        const OsbContainer* node;
        scene::Id parent;
        scene::Index material;  ///< that a group above gives to all below it
    };

    /// From the root, which comes first, downwards; without recursion, since a chain may be long.
    void read_nodes() {
        const OsbContainer& root = file_.containers().front();
        if (root.type != "Node") throw OsbError(root.at, "a Node first", "'" + excerpt(root.type) + "'");
        std::vector<OsbPendingNode> open{{&root, 0, scene::kNone}};
        ids_.emplace(root.id, 0);
        std::vector<OsbPendingNode> children;
        while (!open.empty()) {
            const OsbPendingNode pending = open.back();
            open.pop_back();
            if (progress_)
                progress_(static_cast<double>(ids_.size()) / static_cast<double>(file_.containers().size()));
            children.clear();
            open_children(pending, children);
            add_node(pending, children);
            open.insert(open.end(), children.rbegin(), children.rend());
        }
    }

    /// Each node hangs in one place: what is met again would be a cycle, or stand in two places.
    void open_children(const OsbPendingNode& pending, std::vector<OsbPendingNode>& children) {
        auto ids = pending.node->find("children");
        for (std::size_t left = ids ? ids->take_count(4, "a count") : 0; left > 0; --left) {
            const std::size_t at = ids->at();
            const std::uint32_t id = ids->take_unsigned(4, "an id");
            const OsbContainer* const child = file_.find(id);
            if (child == nullptr || child->type != "Node") {
                warnings_.add("a child that is not a Node of the file is ignored");
                continue;
            }
            if (!ids_.emplace(id, 0).second)
                throw OsbError(at, "a child with one parent", "node " + std::to_string(id) + " again");
            children.push_back({child, 0, pending.material});
        }
    }

    void add_node(const OsbPendingNode& pending, std::vector<OsbPendingNode>& children) {
        scene::Node node;
        node.id = static_cast<scene::Id>(parts_.nodes.size()) + 1;
        node.name = osb_name(file_, *pending.node);
        node.active = pending.node->integer("travMask", -1) != 0;
        for (OsbPendingNode& child : children) child.parent = node.id;
        if (const OsbContainer* const core = file_.find(pending.node->pointer("core"))) {
            if (node.name.empty()) node.name = osb_name(file_, *core);
            read_core(*core, pending, node, children);
        }
        ids_[pending.node->id] = node.id;
        parts_.nodes.push_back({std::move(node), pending.parent});
    }

    void read_core(const OsbContainer& core, const OsbPendingNode& pending, scene::Node& node,
                   std::vector<OsbPendingNode>& children) {
        if (core.type == "Transform" || core.type == "ComponentTransform") {
            node.matrix = matrix_of(core);
        } else if (core.type == "Geometry") {
            const scene::Index material = pending.material != scene::kNone
                                              ? pending.material
                                              : materials_.take(core.pointer("material"));
            node.type = scene::NodeType::geometry;
            node.data = scene::GeometryData{geometries_.take(core), material};
        } else if (core.type == "Switch") {
            node.type = scene::NodeType::switch_;
            node.data = scene::SwitchData{std::max(core.integer("choice", scene::SwitchData::kNoChild),
                                                   scene::SwitchData::kAllChildren)};
        } else if (core.type == "DistanceLOD") {
            node.type = scene::NodeType::lod;
            node.data = scene::LodData{ranges_of(core, children.size())};
        } else if (core.type == "MaterialGroup" && pending.material == scene::kNone) {
            for (OsbPendingNode& child : children) child.material = materials_.take(core.pointer("material"));
        } else if (is_light(core.type)) {
            lights_.push_back({&core, node.id});
        }
    }

    /// Beyond the last one that OpenSG looks at, the last child shows.
    std::vector<double> ranges_of(const OsbContainer& core, std::size_t children) {
        std::vector<double> ranges;
        if (core.vec3("center", {}) != glm::dvec3(0))
            warnings_.add("a DistanceLOD's center is ignored: the distance to its node counts");
        auto data = core.find("range");
        const std::size_t count = data ? data->take_count(4, "a count") : 0;
        while (ranges.size() < count && ranges.size() + 1 < children)
            ranges.push_back(std::max(0.0, data->take_real("a range")));
        return ranges;
    }

    /// Where their beacons are, or else where they hang.
    void add_lights() {
        for (const auto& [core, own] : lights_) {
            scene::Node node = light_of(*core);
            node.id = static_cast<scene::Id>(parts_.nodes.size()) + 1;
            const auto beacon = ids_.find(core->pointer("beacon"));
            parts_.nodes.push_back({std::move(node), beacon != ids_.end() ? beacon->second : own});
            warnings_.add(
                "a light illuminates the whole scene with its diffuse colour: its scope and specular colour "
                "are ignored");
        }
    }

    void report_skipped() {
        std::map<std::string_view, std::size_t> count;
        for (const OsbContainer& container : file_.containers())
            if (std::find(std::begin(kKnownTypes), std::end(kKnownTypes), container.type) ==
                std::end(kKnownTypes))
                ++count[container.type];
        Notices notices;
        for (const auto& [type, times] : count)
            notices.add(file_name_ + ": containers of type '" + excerpt(type) + "' are ignored (" +
                        std::to_string(times) + (times > 1 ? " times)" : " time)"));
        notices.append_to(parts_.notices);
    }

    std::string file_name_;
    const ReadProgress& progress_;
    OsbFile file_;
    ConversionWarnings warnings_;
    OsbGeometries geometries_{file_, warnings_};
    OsbMaterials materials_{file_, warnings_};
    scene::SceneParts parts_;
    std::unordered_map<std::uint32_t, scene::Id, base::SaltedHash> ids_;  // ours, of the nodes met
    struct OsbLight {
        const OsbContainer* core;
        scene::Id node;
    };
    std::vector<OsbLight> lights_;
};

}  // namespace

PartsResult read_osb_parts(std::string_view bytes, const std::string& file, const ReadProgress& progress) {
    try {
        return OsbReader(bytes, file, progress).read();
    } catch (const OsbError& fault) {
        return tl::unexpected(file + ": " + fault.what());
    }
}

PartsResult read_osb_scene(const std::filesystem::path& path, const ReadProgress& progress,
                           const ReadOptions& options) {
    const auto bytes = base::read_bytes(path);
    if (!bytes) return tl::unexpected(path.string() + ": " + bytes.error());
    auto parts = read_osb_parts(*bytes, path.string(), progress);
    if (parts) read_textures(*parts, path, progress, options.texture_folders);
    return parts;
}

}  // namespace vrut::io
