#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "math/bounds.hpp"
#include "math/plane.hpp"
#include "scene/image.hpp"

namespace vrut::scene {

/// Identifiers of nodes, materials and geometries as a file gives them: 0 to 2^53 - 1, exact in JSON.
using Id = std::int64_t;
inline constexpr Id kMaxId = (Id{1} << 53) - 1;

/// Position in one of the scene's arrays; kNone where nothing is meant.
using Index = std::int32_t;
inline constexpr Index kNone = -1;

/// What lies beyond an image's edge: the image again, its mirror image, or the edge's pixels.
enum class Wrap { repeat, mirror, clamp };

/// The keyword of the scene text format.
std::string_view name_of(Wrap wrap);

/// What is seen of texels that are larger than pixels: a mix of the four around it, or the one in which it
/// lies.
enum class Magnification { linear, nearest };

/// The keyword of the scene text format.
std::string_view name_of(Magnification magnification);

/// How the colour of an image is found at texture coordinates.
struct Sampler {
    std::array<Wrap, 2> wraps{Wrap::repeat, Wrap::repeat};  ///< along u, and along v
    Magnification magnification = Magnification::linear;

    bool operator==(const Sampler&) const = default;
    bool operator<(const Sampler& other) const {
        return std::tie(wraps, magnification) < std::tie(other.wraps, other.magnification);
    }
    bool repeats() const { return wraps == Sampler().wraps; }
};

/// An image file that materials and backgrounds show.
struct Texture {
    std::string file;  ///< relative to the scene's, or absolute
    Image image;
    bool transparent = false;  ///< some alpha is below 255
    Sampler sampler = {};
};

/// A surface as glTF describes it: how much of it is metal, and how rough it is, 0 to 1. `clear_coat` is how
/// much of it lies under a smooth, clear layer.
struct MetallicRoughness {
    double metallic = 0, roughness = 1, clear_coat = 0;

    bool operator==(const MetallicRoughness&) const = default;
};

/// RGBA 0 to 1 as displayed: no gamma anywhere.
struct Material {
    Id id = 0;
    std::string name;
    glm::dvec4 ambient{0, 0, 0, 1};
    glm::dvec4 diffuse{0.8, 0.8, 0.8, 1};
    glm::dvec4 specular{0, 0, 0, 1};
    glm::dvec4 emission{0, 0, 0, 1};
    double shininess = 0;
    double reflectivity = 0;
    bool two_sided = false;
    /// RGB of light that the surface sends by itself, linear: it is added to what is displayed as light is
    /// added, and not as numbers are, as the emission is.
    glm::dvec3 emissive{0};
    std::string image;           ///< relative to the scene's file; empty for none
    Index texture = kNone;       ///< what was read from there; kNone where nothing could be
    std::string emissive_image;  ///< its linear colours multiply `emissive`
    Index emissive_texture = kNone;
    /// Where a view has a cube map, light is computed by it (Cook and Torrance 1982), with the diffuse colour
    /// as the base colour, and the other colours and the shininess do not count. Else, and where there is
    /// none, by Phong's equation.
    std::optional<MetallicRoughness> metallic_roughness;
    /// Red multiplies the light of the surroundings, green the roughness, blue the metal.
    std::string occlusion_roughness_metallic_image;
    Index occlusion_roughness_metallic_texture = kNone;
    /// Normals in the space of the texture coordinates: RGB from 0 to 1 is -1 to 1 along u, v and the normal.
    std::string normal_image;
    Index normal_texture = kNone;
    double normal_scale = 1;  ///< multiplies what they have along u and v
    Sampler sampler;          ///< of all its images; its textures have the same
};

struct Geometry {
    Id id = 0;
    std::vector<glm::dvec3> positions;
    std::vector<glm::vec3> normals;    ///< one for each position, or none: then triangles are flat
    std::vector<glm::vec2> texcoords;  ///< one for each position, or none; a Scene's: move_near_zero()
    /// RGB 0 to 1 as displayed, one for each position, or none: what the material reflects of ambient and
    /// diffuse light is multiplied by it. Interpolated linearly.
    std::vector<glm::vec3> colors;
    std::vector<glm::uvec3> triangles;  ///< counter-clockwise from the front
    math::Bounds bounds;
};

enum class NodeType { assembly, root, camera, geometry, light, lod, switch_, background, sound };

/// The keyword of the scene text format.
std::string_view name_of(NodeType type);

struct GroupData {};

struct GeometryData {
    Index geometry = kNone;
    Index material = kNone;  ///< kNone: the default material
};

/// In the node's own space; `fov` is vertical, in degrees.
struct CameraData {
    glm::dvec3 eye{0, 0, 0}, focus{0, 0, -1}, up{0, 1, 0};
    double fov = 40;
    /// Within this distance from its eye, in world space, drags look around; 0: nowhere.
    double look_radius = 0;
};

struct LightData {
    enum class Type { point, directional, spot };
    Type type = Type::point;
    glm::dvec4 color{1, 1, 1, 1};
    glm::dvec3 attenuation{1, 0, 0};  ///< constant, linear, quadratic; all zero means none
    double angle = 90;                ///< a spot's full cone in degrees
};

struct SwitchData {
    static constexpr int kNoChild = -1, kAllChildren = -2;
    int active_child = 0;
};

struct LodData {
    std::vector<double> ranges;  ///< child k shows while the distance is below ranges[k]
};

struct BackgroundData {
    Index material = kNone;
    std::optional<std::array<std::string, 6>> cube_map;  ///< px nx py ny pz nz
    /// What was read from there: squares of one size, or none.
    std::optional<std::array<Index, 6>> cube_textures;
    bool only_reflected = false;  ///< surfaces reflect the cube map; behind them the material is seen
};

/// How a door or a lid opens: it turns about an axis of its own space, through its own origin.
struct Hinge {
    glm::dvec3 axis{0, 1, 0};  ///< as the file gives it: of any length but 0
    double degrees = 0;        ///< how far it opens, right-handed about the axis; -360 to 360

    bool operator==(const Hinge&) const = default;
};

/// The hinge's axis with length 1.
glm::dvec3 unit_axis(const Hinge& hinge);

struct Node {
    Id id = 0;
    std::string name;
    NodeType type = NodeType::assembly;
    Index parent = kNone;         ///< kNone for the root only
    std::vector<Index> children;  ///< by rising id
    bool active = true;
    glm::dmat4 matrix{1};  ///< parent from node
    std::variant<GroupData, GeometryData, CameraData, LightData, SwitchData, LodData, BackgroundData> data;
    std::optional<Hinge> hinge = {};  ///< of assemblies and geometry nodes
    /// What hangs at and below it presents the product and is no part of it, as a shadow or a studio: not
    /// picked, not fitted into the view, and left out of drawings. Of assemblies and geometry nodes.
    bool presentation = false;
};

/// A reader's result: nodes still refer to their parents by id.
struct SceneParts {
    struct PartNode {
        Node node;
        Id parent_id = 0;
        std::size_t line = 0;  ///< of the file, for errors; 0 where it has none
    };
    std::string name;
    std::optional<double> unit = {};  ///< metres per unit; none where the file names none
    std::vector<Texture> textures;
    std::vector<Material> materials;
    std::vector<Geometry> geometries;
    std::vector<PartNode> nodes;
    std::vector<std::string> notices;
};

/// A scene graph: plain data. Nodes stand in the array so that each parent comes before its children; a walk
/// is a loop, and a chain of a million nodes needs no stack.
class Scene {
public:
    /// The error message, and the index in SceneParts::nodes of the node at fault.
    struct BuildError {
        std::string message;
        std::size_t node = 0;
    };

    /// Where the node of an id stands, by rising id.
    using IdToIndex = std::vector<std::pair<Id, Index>>;

    /// An empty scene: the root alone.
    Scene();
    /// Links nodes to their parents, adds the root where it is left out, orders everything by id.
    static tl::expected<Scene, BuildError> build(SceneParts parts);

    const std::string& name() const { return name_; }
    /// Metres per unit; none where the file names none.
    std::optional<double> unit() const { return unit_; }
    const std::vector<Texture>& textures() const { return textures_; }
    const std::vector<Material>& materials() const { return materials_; }
    const std::vector<Geometry>& geometries() const { return geometries_; }
    const std::vector<Node>& nodes() const { return nodes_; }
    const std::vector<std::string>& notices() const { return notices_; }
    const Material& material(Index index) const;
    /// The plane in which a geometry lies, in its own space (fitted_plane()).
    const std::optional<math::Plane>& plane(Index geometry) const {
        return planes_[static_cast<std::size_t>(geometry)];
    }
    /// Returns true if float positions round what a viewer may see: some instance is longer than 256 m where
    /// the file places it, so that they are wrong by 8 µm at its ends. They are then sums of two floats
    /// (double-single arithmetic; Cozzi and Ring 2011, 3D Engine Design for Virtual Globes, 5.4).
    bool needs_double_single(Index geometry) const {
        constexpr double kLongestInFloat = 256;
        return extents_[static_cast<std::size_t>(geometry)] > kLongestInFloat;
    }
    /// Returns true if something can be seen through it: its diffuse alpha or one of its texture's is
    /// below 1.
    bool is_transparent(const Material& material) const;
    /// The same on a geometry: without texture coordinates it shows no texture.
    bool is_transparent(const Material& material, Index geometry) const;
    /// Returns true if a geometry with that material is a planar mirror. Other reflective ones reflect the
    /// environment map.
    bool is_mirror(const Material& material, Index geometry) const;
    /// Returns true if the node or one above it is marked as presentation.
    bool is_presentation(Index node) const { return is_presentation_[static_cast<std::size_t>(node)]; }
    /// Camera nodes with a CameraData::look_radius.
    const std::vector<Index>& looking_cameras() const { return looking_cameras_; }
    /// Backgrounds with a cube map that is BackgroundData::only_reflected, by rising id.
    const std::vector<Index>& reflected_backgrounds() const { return reflected_backgrounds_; }
    /// Returns true if what is shown depends on the eye.
    bool has_lods() const { return has_lods_; }
    const IdToIndex& index_by_id() const { return index_by_id_; }
    Index find_node(Id id) const;
    /// Triangles of all geometry nodes, instances counted each.
    std::uint64_t triangle_count() const;

private:
    struct Unlinked {};
    explicit Scene(Unlinked) {}

    std::string name_;
    std::optional<double> unit_;
    std::vector<Texture> textures_;
    std::vector<Material> materials_;
    std::vector<Geometry> geometries_;
    std::vector<std::optional<math::Plane>> planes_;
    std::vector<double> extents_;  // of geometries, in metres
    std::vector<Node> nodes_;
    std::vector<bool> is_presentation_;  // one for each node
    std::vector<Index> looking_cameras_, reflected_backgrounds_;
    bool has_lods_ = false;
    std::vector<std::string> notices_;
    IdToIndex index_by_id_;
};

/// The mutable state of a node; initially as in the file.
struct NodeState {
    bool active = true;
    int active_child = 0;    ///< of a switch, as SwitchData's
    Index material = kNone;  ///< of a geometry node; kNone: the default material
    glm::dmat4 matrix{1};    ///< parent from node

    bool operator==(const NodeState&) const = default;
};

/// As its file has it.
NodeState file_state(const Node& node);
/// One for each of the scene's nodes.
std::vector<NodeState> file_states(const Scene& scene);

/// A scene, its nodes' states, and what follows from them.
struct PlacedScene {
    std::shared_ptr<const Scene> scene;  ///< never null
    std::vector<NodeState> nodes;        ///< one for each of the scene's
    std::vector<glm::dmat4> world;       ///< world from node
    math::Bounds bounds;                 ///< subtree_bounds of the root
    /// Geometry nodes with triangles that are shown from some eye (shown_nodes()), by rising id.
    std::vector<Index> drawable;
};

/// As the file says.
PlacedScene place(Scene scene);
/// `nodes` holds one state for each of the scene's nodes.
PlacedScene place(std::shared_ptr<const Scene> scene, std::vector<NodeState> nodes);

/// World from node for each node.
std::vector<glm::dmat4> world_matrices(const Scene& scene, const std::vector<NodeState>& states);

/// Returns for each node whether it is shown: it and its ancestors are active, and switches and LODs select
/// it. LODs select by the distance of `eye` (world space); without an eye all their children count.
std::vector<bool> shown_nodes(const PlacedScene& placed, const std::optional<glm::dvec3>& eye);
/// The same for one node; false for kNone.
bool is_shown(const PlacedScene& placed, Index node, const std::optional<glm::dvec3>& eye);

/// For each node, whether it is `top` or hangs below it.
std::vector<bool> subtree(const Scene& scene, Index top);

/// Box around the geometry at and below `node` that could show from anywhere: active and chosen by its
/// switches. Nodes that lie beyond the range of double are left out.
math::Bounds subtree_bounds(const PlacedScene& placed, Index node);

/// Objects further from the eye are neither drawn nor picked: positions are float on the GPU, and squared
/// there.
inline constexpr double kMaxDrawDistance = 1e18;

/// Volume of the matrix's axes over that of a box with the same edges: 0 for a flattened part, ±1 for a rigid
/// one.
double relative_determinant(const glm::dmat3& m);

/// True when every number of the matrix is finite.
bool is_finite(const glm::dmat4& matrix);

}  // namespace vrut::scene
