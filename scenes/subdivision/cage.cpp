#include "cage.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_access.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <stdexcept>

namespace vrut {

namespace {

using Json = nlohmann::json;

[[noreturn]] void fail(const std::string& who, const std::string& what) {
    throw std::runtime_error(who + ": " + what);
}

std::string in_quotes(const std::string& text) { return "\"" + text + "\""; }

/// What an error repeats of a value. Lists in lists stay out: dump() descends, and hostile ones have no end.
std::string excerpt(const Json& value) {
    if (value.is_object()) return "an object";
    if (value.is_array() &&
        std::any_of(value.begin(), value.end(), [](const Json& v) { return v.is_structured(); }))
        return "a list of lists or objects";
    return value.dump(-1, ' ', true).substr(0, 40);
}

struct Range {
    double low, high;
};
constexpr Range kAnywhere{-1e9, 1e9};  // products of what is within stay far from the range of double
constexpr Range kColors{0, 1e6}, kShares{0, 1}, kDistances{0, 1e9};

std::string text_of(double number) {
    std::ostringstream text;
    text << number;
    return text.str();
}

double to_number(const Json& value, const std::string& who, const std::string& what,
                 const Range& range = kAnywhere) {
    if (!value.is_number()) fail(who, "expected a number as " + what + ", found " + excerpt(value));
    const auto number = value.get<double>();
    if (!(number >= range.low && number <= range.high))
        fail(who, "expected a number from " + text_of(range.low) + " to " + text_of(range.high) + " as " +
                      what + ", found " + excerpt(value));
    return number;
}

scene::Id to_integer(const Json& value, scene::Id min, scene::Id max, const std::string& who,
                     const std::string& what) {
    const bool beyond =
        value.is_number_unsigned() && value.get<std::uint64_t>() > std::uint64_t{scene::kMaxId};
    if (!value.is_number_integer() || beyond || value.get<scene::Id>() < min || value.get<scene::Id>() > max)
        fail(who, "expected an integer from " + std::to_string(min) + " to " + std::to_string(max) + " as " +
                      what + ", found " + excerpt(value));
    return value.get<scene::Id>();
}

int to_place(const Json& value, std::size_t count, const std::string& who, const std::string& what) {
    if (count == 0) fail(who, "expected no " + what + " as there are none, found " + excerpt(value));
    return static_cast<int>(to_integer(value, 0, static_cast<scene::Id>(count) - 1, who, what));
}

std::string to_text(const Json& value, const std::string& who, const std::string& what) {
    if (!value.is_string()) fail(who, "expected a string as " + what + ", found " + excerpt(value));
    auto text = value.get<std::string>();
    // Scene text has no way to write them.
    if (std::any_of(text.begin(), text.end(), [](unsigned char c) { return c < ' '; }))
        fail(who, "expected no control characters in " + what + ", found " + excerpt(value));
    return text;
}

bool to_flag(const Json& value, const std::string& who, const std::string& what) {
    if (!value.is_boolean()) fail(who, "expected true or false as " + what + ", found " + excerpt(value));
    return value.get<bool>();
}

const Json& to_list(const Json& value, const std::string& who, const std::string& what) {
    if (!value.is_array()) fail(who, "expected a list as " + what + ", found " + excerpt(value));
    return value;
}

template <std::size_t N>
std::array<double, N> to_numbers(const Json& value, const std::string& who, const std::string& what) {
    if (!value.is_array() || value.size() != N)
        fail(who, "expected " + std::to_string(N) + " numbers as " + what + ", found " + excerpt(value));
    std::array<double, N> numbers{};
    for (std::size_t i = 0; i < N; ++i) numbers[i] = to_number(value[i], who, what);
    return numbers;
}

glm::dvec3 to_point(const Json& value, const std::string& who, const std::string& what) {
    const auto [x, y, z] = to_numbers<3>(value, who, what);
    return {x, y, z};
}

glm::dvec4 to_color(const Json& value, const std::string& who, const std::string& what) {
    const auto [r, g, b, a] = to_numbers<4>(value, who, what);
    for (int i = 0; i < 4; ++i)
        to_number(value[static_cast<std::size_t>(i)], who, what, i < 3 ? kColors : kShares);
    return {r, g, b, a};
}

/// An object's members; each can be asked for once, and one that nobody asked for is an error.
class Members {
public:
    Members(const Json& object, std::string who) : object_(object), who_(std::move(who)) {
        if (!object.is_object()) fail(who_, "expected an object, found " + excerpt(object));
    }

    const std::string& who() const { return who_; }
    void rename(std::string who) { who_ = std::move(who); }

    const Json* find(const char* name) {
        asked_.insert(name);
        const auto member = object_.find(name);
        return member == object_.end() ? nullptr : &*member;
    }
    const Json& need(const char* name) {
        if (const Json* value = find(name)) return *value;
        fail(who_, std::string("expected the member ") + in_quotes(name) + ", found none");
    }

    void read(const char* name, double& number, const Range& range = kAnywhere) {
        if (const Json* value = find(name)) number = to_number(*value, who_, name, range);
    }
    void read(const char* name, bool& flag) {
        if (const Json* value = find(name)) flag = to_flag(*value, who_, name);
    }
    void read(const char* name, std::string& text) {
        if (const Json* value = find(name)) text = to_text(*value, who_, name);
    }
    void read(const char* name, glm::dvec3& point) {
        if (const Json* value = find(name)) point = to_point(*value, who_, name);
    }
    void read(const char* name, glm::dvec4& color) {
        const Json* value = find(name);
        if (value == nullptr) return;
        color = to_color(*value, who_, name);
    }

    void expect_no_more() const {
        for (const auto& [name, value] : object_.items())
            if (!asked_.contains(name)) fail(who_, "unknown member " + in_quotes(name));
    }

private:
    const Json& object_;
    std::string who_;
    std::set<std::string> asked_;
};

// --- meshes

using Edge = std::pair<int, int>;

Edge edge_of(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// One or two faces at every edge, and two that wind the same way.
std::set<Edge> check_edges(const Cage& cage, const std::string& who) {
    std::map<Edge, std::array<int, 2>> faces;  // along the edge and against it
    for (const auto& quad : cage.quads)
        for (std::size_t k = 0; k < 4; ++k) {
            const int a = quad[k], b = quad[(k + 1) % 4];
            ++faces[edge_of(a, b)][a < b ? 0 : 1];
        }
    std::set<Edge> edges;
    for (const auto& [edge, count] : faces) {
        const std::string at = std::to_string(edge.first) + "-" + std::to_string(edge.second);
        if (count[0] + count[1] > 2)
            fail(who, "expected one or two faces at edge " + at + ", found " +
                          std::to_string(count[0] + count[1]));
        if (count[0] == 2 || count[1] == 2) fail(who, "the two faces at edge " + at + " wind opposite ways");
        edges.insert(edge);
    }
    return edges;
}

void read_creases(const Json& list, Cage& cage, const std::set<Edge>& edges, const std::string& who) {
    for (const Json& value : to_list(list, who, "creases")) {
        if (!value.is_array() || value.size() != 3)
            fail(who, "expected [point, point, sharpness] as a crease, found " + excerpt(value));
        Crease crease;
        crease.a = to_place(value[0], cage.points.size(), who, "a crease's point");
        crease.b = to_place(value[1], cage.points.size(), who, "a crease's point");
        crease.sharpness = to_number(value[2], who, "a crease's sharpness");
        const std::string at = std::to_string(crease.a) + "-" + std::to_string(crease.b);
        if (!(crease.sharpness >= 0 && crease.sharpness <= kHard))
            fail(who, "expected a sharpness from 0 to 10 at crease " + at + ", found " + excerpt(value[2]));
        if (!edges.contains(edge_of(crease.a, crease.b))) fail(who, "crease " + at + " is no edge of a quad");
        cage.creases.push_back(crease);
    }
}

Cage read_mesh(const Json& value, std::size_t number, double unit) {
    Members members(value, "mesh " + std::to_string(number));
    Cage cage;
    members.read("name", cage.name);
    members.rename("mesh " + std::to_string(number) + " " + in_quotes(cage.name));
    const std::string& who = members.who();
    members.read("smooth", cage.smooth);
    for (const Json& point : to_list(members.need("points"), who, "points"))
        cage.points.push_back(unit * to_point(point, who, "a point"));
    if (const Json* texcoords = members.find("texcoords")) {
        for (const Json& place : to_list(*texcoords, who, "texcoords")) {
            const auto [u, v] = to_numbers<2>(place, who, "a texture coordinate");
            cage.texcoords.emplace_back(u, v);
        }
        if (cage.texcoords.size() != cage.points.size())
            fail(who, "expected as many texcoords as points (" + std::to_string(cage.points.size()) +
                          "), found " + std::to_string(cage.texcoords.size()));
    }
    const Json& quads = to_list(members.need("quads"), who, "quads");
    if (quads.empty()) fail(who, "expected quads, found none");
    for (std::size_t i = 0; i < quads.size(); ++i) {
        const std::string what = "quad " + std::to_string(i);
        if (!quads[i].is_array() || quads[i].size() != 4)
            fail(who, "expected four points as " + what + ", found " + excerpt(quads[i]));
        std::array<int, 4>& quad = cage.quads.emplace_back();
        for (std::size_t k = 0; k < 4; ++k)
            quad[k] = to_place(quads[i][k], cage.points.size(), who, "a point of " + what);
        for (std::size_t k = 0; k < 4; ++k)
            for (std::size_t l = k + 1; l < 4; ++l)
                if (quad[k] == quad[l]) fail(who, what + " has point " + std::to_string(quad[k]) + " twice");
    }
    const std::set<Edge> edges = check_edges(cage, who);
    if (const Json* creases = members.find("creases")) read_creases(*creases, cage, edges, who);
    members.expect_no_more();
    return cage;
}

// --- skins

Outline::From to_from(const std::string& name, const std::string& who) {
    using From = Outline::From;
    static const std::map<std::string, From> known = {{"left", From::left},   {"right", From::right},
                                                      {"sides", From::sides}, {"top", From::top},
                                                      {"front", From::front}, {"rear", From::rear}};
    const auto found = known.find(name);
    if (found == known.end())
        fail(who, "expected left, right, sides, top, front or rear as from, found " + in_quotes(name));
    return found->second;
}

Outline read_outline(const Json& value, const std::string& who) {
    Members members(value, who);
    Outline outline;
    outline.from = to_from(to_text(members.need("from"), who, "from"), who);
    for (const Json& corner : to_list(members.need("outline"), who, "an outline")) {
        const auto [a, b, radius] = to_numbers<3>(corner, who, "an outline's corner");
        if (radius < 0) fail(who, "expected a radius of 0 or more in an outline, found " + excerpt(corner));
        outline.corners.push_back({{a, b}, radius});
    }
    if (outline.corners.size() < 3)
        fail(who,
             "expected three or more corners in an outline, found " + std::to_string(outline.corners.size()));
    for (std::size_t i = 0; i < outline.corners.size(); ++i) {
        const glm::dvec2 &a = outline.corners[i].place,
                         &b = outline.corners[(i + 1) % outline.corners.size()].place;
        if (glm::distance(a, b) < 1e-6)
            fail(who, "expected an outline's corners apart from each other, found two at " + text_of(a.x) +
                          " " + text_of(a.y));
    }
    members.expect_no_more();
    return outline;
}

Skin read_skin(const Json& value, std::size_t number, const std::vector<Cage>& meshes) {
    Members members(value, "skin " + std::to_string(number));
    Skin skin;
    skin.mesh = to_place(members.need("mesh"), meshes.size(), members.who(), "mesh");
    if (const Json* cuts = members.find("cuts"))
        for (const Json& entry : to_list(*cuts, members.who(), "cuts")) {
            Members cut_members(entry, members.who() + ", cut " + std::to_string(skin.cuts.size()));
            Cut cut;
            cut.name = to_text(cut_members.need("name"), cut_members.who(), "name");
            const std::string who = members.who() + ", cut " + in_quotes(cut.name);
            cut_members.rename(who);
            for (const Cut& other : skin.cuts)
                if (other.name == cut.name) fail(who, "there are two cuts of this name");
            cut_members.read("gap", cut.gap);
            cut_members.read("detail", cut.detail);
            if (cut.gap < 0) fail(who, "expected a gap of 0 or more");
            for (const Json& outline : to_list(cut_members.need("within"), who, "within"))
                cut.within.push_back(read_outline(outline, who));
            if (cut.within.empty()) fail(who, "expected outlines in within, found none");
            cut_members.expect_no_more();
            skin.cuts.push_back(std::move(cut));
        }
    members.expect_no_more();
    return skin;
}

// --- materials and nodes

scene::Material read_material(const Json& value, std::size_t number) {
    Members members(value, "material " + std::to_string(number));
    scene::Material material;
    material.id = static_cast<scene::Id>(number) + 1;
    material.name = to_text(members.need("name"), members.who(), "name");
    members.rename("material " + in_quotes(material.name));
    members.read("ambient", material.ambient);
    members.read("diffuse", material.diffuse);
    members.read("specular", material.specular);
    members.read("emission", material.emission);
    members.read("shininess", material.shininess, {0, 10000});
    members.read("reflectivity", material.reflectivity, kShares);
    members.read("twoSided", material.two_sided);
    members.read("image", material.image);
    members.expect_no_more();
    return material;
}

class NodeReader {
public:
    explicit NodeReader(CageScene& scene) : scene_(scene) {
        for (const scene::Material& material : scene.materials)
            if (!materials_.emplace(material.name, static_cast<scene::Index>(materials_.size())).second)
                fail("material " + in_quotes(material.name), "there are two materials of this name");
    }

    void read(const Json& value) {
        Members members(value, "node at place " + std::to_string(scene_.nodes.size()));
        CageNode result;
        scene::Node& node = result.part.node;
        node.id = to_integer(members.need("id"), 0, scene::kMaxId, members.who(), "id");
        members.read("name", node.name);
        members.rename("node " + std::to_string(node.id) + " " + in_quotes(node.name));
        node.type = type_of(to_text(members.need("type"), members.who(), "type"), members.who());
        if (const Json* parent = members.find("parent"); parent && !parent->is_null())
            result.part.parent_id = to_integer(*parent, 0, scene::kMaxId, members.who(), "parent");
        members.read("active", node.active);
        if (const Json* matrix = members.find("matrix")) read_matrix(*matrix, node, members.who());
        if (node.type == scene::NodeType::assembly || node.type == scene::NodeType::geometry) {
            if (const Json* hinge = members.find("hinge")) node.hinge = to_hinge(*hinge, members.who());
            members.read("presentation", node.presentation);
        }
        read_type(members, result);
        members.expect_no_more();
        if (!places_.emplace(node.id, scene_.nodes.size()).second)
            fail(members.who(), "there are two nodes of this id");
        scene_.nodes.push_back(std::move(result));
    }

    /// What names other nodes, once all are known.
    void check() const {
        for (const CageNode& entry : scene_.nodes) {
            const scene::Node& node = entry.part.node;
            const std::string who = "node " + std::to_string(node.id) + " " + in_quotes(node.name);
            if (entry.part.parent_id != 0 && !places_.contains(entry.part.parent_id))
                fail(who, "unknown parent " + std::to_string(entry.part.parent_id));
            if (!entry.geometry_of) continue;
            const std::string other = std::to_string(*entry.geometry_of);
            const auto place = places_.find(*entry.geometry_of);
            if (place == places_.end()) fail(who, "geometryOf names the unknown node " + other);
            const CageNode& source = scene_.nodes[place->second];
            if (source.mesh == scene::kNone && !source.panel)
                fail(who, "geometryOf names node " + other + ", which has no mesh or panel of its own");
        }
    }

private:
    static scene::NodeType type_of(const std::string& name, const std::string& who) {
        for (const scene::NodeType type :
             {scene::NodeType::assembly, scene::NodeType::geometry, scene::NodeType::switch_,
              scene::NodeType::lod, scene::NodeType::light, scene::NodeType::camera,
              scene::NodeType::background})
            if (name == scene::name_of(type)) return type;
        if (name == "root") return scene::NodeType::root;
        fail(who, "expected assembly, geometry, switch, lod, light, camera or background as type, found " +
                      in_quotes(name));
    }

    static void read_matrix(const Json& value, scene::Node& node, const std::string& who) {
        const auto numbers = to_numbers<16>(value, who, "a matrix");
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 4; ++column)
                node.matrix[column][row] =
                    numbers[4 * static_cast<std::size_t>(row) + static_cast<std::size_t>(column)];
        if (glm::row(node.matrix, 3) != glm::dvec4(0, 0, 0, 1))
            fail(who, "expected 0 0 0 1 as the matrix's last row");
    }

    static scene::Hinge to_hinge(const Json& value, const std::string& who) {
        const auto [x, y, z, degrees] = to_numbers<4>(value, who, "a hinge");
        if (glm::dvec3(x, y, z) == glm::dvec3(0))
            fail(who, "expected a hinge's axis that is not zero, found " + excerpt(value));
        if (std::abs(degrees) > 360)
            fail(who, "expected a hinge's degrees from -360 to 360, found " + excerpt(value));
        return {{x, y, z}, degrees};
    }

    scene::Index material(Members& members) const {
        const Json* value = members.find("material");
        if (value == nullptr) return scene::kNone;
        const std::string name = to_text(*value, members.who(), "material");
        const auto found = materials_.find(name);
        if (found == materials_.end()) fail(members.who(), "unknown material " + in_quotes(name));
        return found->second;
    }

    void read_type(Members& members, CageNode& result) {
        scene::Node& node = result.part.node;
        switch (node.type) {
            case scene::NodeType::geometry:
                node.data = scene::GeometryData{scene::kNone, material(members)};
                read_geometry(members, result);
                break;
            case scene::NodeType::switch_:
                if (const Json* child = members.find("activeChild"))
                    node.data = scene::SwitchData{static_cast<int>(to_integer(
                        *child, scene::SwitchData::kAllChildren, 1 << 30, members.who(), "activeChild"))};
                else
                    node.data = scene::SwitchData{};
                break;
            case scene::NodeType::lod: {
                auto& data = node.data.emplace<scene::LodData>();
                for (const Json& range : to_list(members.need("ranges"), members.who(), "ranges"))
                    data.ranges.push_back(to_number(range, members.who(), "a range", kDistances));
                break;
            }
            case scene::NodeType::light:
                read_light(members, node.data.emplace<scene::LightData>());
                break;
            case scene::NodeType::camera: {
                auto& camera = node.data.emplace<scene::CameraData>();
                members.read("eye", camera.eye);
                members.read("focus", camera.focus);
                members.read("up", camera.up);
                members.read("fov", camera.fov, {1, 170});
                members.read("look", camera.look_radius, {0, 1e6});
                break;
            }
            case scene::NodeType::background:
                read_background(members, node);
                break;
            default:
                break;
        }
    }

    void read_geometry(Members& members, CageNode& result) const {
        const std::string& who = members.who();
        members.read("tolerance", result.tolerance);
        if (!(result.tolerance > 0)) fail(who, "expected a tolerance above 0");
        members.read("detail", result.detail);
        if (const Json* mesh = members.find("mesh"))
            result.mesh = to_place(*mesh, scene_.meshes.size(), who, "mesh");
        if (const Json* panel = members.find("panel")) result.panel = read_panel(*panel, who);
        if (const Json* other = members.find("geometryOf"))
            result.geometry_of = to_integer(*other, 0, scene::kMaxId, who, "geometryOf");
        if ((result.mesh != scene::kNone) + result.panel.has_value() + result.geometry_of.has_value() != 1)
            fail(who, "expected one of mesh, panel and geometryOf");
    }

    Panel read_panel(const Json& value, const std::string& who) const {
        Members members(value, who + ", panel");
        Panel panel;
        panel.skin = to_place(members.need("skin"), scene_.skins.size(), members.who(), "skin");
        if (const Json& cut = members.need("cut"); !cut.is_null()) {
            const std::string name = to_text(cut, members.who(), "cut");
            const auto& cuts = scene_.skins[static_cast<std::size_t>(panel.skin)].cuts;
            const auto found =
                std::find_if(cuts.begin(), cuts.end(), [&](const Cut& c) { return c.name == name; });
            if (found == cuts.end()) fail(members.who(), "unknown cut " + in_quotes(name));
            panel.cut = static_cast<int>(found - cuts.begin());
        }
        members.read("lift", panel.lift);
        members.read("thickness", panel.thickness);
        members.read("edge", panel.edge);
        members.read("grow", panel.grow);
        if (!(panel.edge >= 0 && panel.thickness > panel.edge))
            fail(members.who(), "expected an edge of 0 or more and a thickness above it");
        if (const Json* layer = members.find("layer")) {
            const std::string name = to_text(*layer, members.who(), "layer");
            if (name == "outside")
                panel.layer = Panel::Layer::outside;
            else if (name == "inside")
                panel.layer = Panel::Layer::inside;
            else if (name == "back")
                panel.layer = Panel::Layer::back;
            else
                fail(members.who(), "expected the layer outside, inside or back, not " + in_quotes(name));
        }
        members.expect_no_more();
        return panel;
    }

    static void read_light(Members& members, scene::LightData& light) {
        std::string type = "point";
        members.read("lightType", type);
        if (type == "directional")
            light.type = scene::LightData::Type::directional;
        else if (type == "spot")
            light.type = scene::LightData::Type::spot;
        else if (type != "point")
            fail(members.who(), "expected point, directional or spot as lightType, found " + in_quotes(type));
        members.read("color", light.color);
        members.read("attenuation", light.attenuation);
        if (glm::any(glm::lessThan(light.attenuation, glm::dvec3(0))))
            fail(members.who(), "expected an attenuation of 0 or more");
        members.read("angle", light.angle, {0, 180});
    }

    /// A background's own image becomes a material that shows it.
    void read_background(Members& members, scene::Node& node) {
        scene::BackgroundData data;
        data.material = material(members);
        if (const Json* image = members.find("image")) {
            scene::Material& shown = scene_.materials.emplace_back();
            shown.id = static_cast<scene::Id>(scene_.materials.size());
            shown.name = node.name;
            shown.image = to_text(*image, members.who(), "image");
            data.material = static_cast<scene::Index>(scene_.materials.size() - 1);
        }
        if (const Json* faces = members.find("cubeMap")) {
            if (to_list(*faces, members.who(), "cubeMap").size() != 6)
                fail(members.who(),
                     "expected six pictures as cubeMap, found " + std::to_string(faces->size()));
            auto& files = data.cube_map.emplace();
            for (std::size_t i = 0; i < 6; ++i) files[i] = to_text((*faces)[i], members.who(), "a picture");
        }
        node.data = std::move(data);
    }

    CageScene& scene_;
    std::map<std::string, scene::Index> materials_;
    std::map<scene::Id, std::size_t> places_;  // of nodes
};

CageScene read(const Json& root) {
    Members members(root, "the file");
    CageScene scene;
    const double unit = to_number(members.need("unit"), members.who(), "unit", {0, 1000});
    if (!(unit > 0)) fail(members.who(), "expected a unit above 0");
    if (const Json* materials = members.find("materials"))
        for (const Json& material : to_list(*materials, members.who(), "materials"))
            scene.materials.push_back(read_material(material, scene.materials.size()));
    if (const Json* meshes = members.find("meshes"))
        for (const Json& mesh : to_list(*meshes, members.who(), "meshes"))
            scene.meshes.push_back(read_mesh(mesh, scene.meshes.size(), unit));
    if (const Json* skins = members.find("skins"))
        for (const Json& skin : to_list(*skins, members.who(), "skins"))
            scene.skins.push_back(read_skin(skin, scene.skins.size(), scene.meshes));
    NodeReader nodes(scene);
    for (const Json& node : to_list(members.need("nodes"), members.who(), "nodes")) nodes.read(node);
    nodes.check();
    members.expect_no_more();
    return scene;
}

}  // namespace

tl::expected<CageScene, std::string> read_cage_scene(std::string_view text) {
    try {
        return read(Json::parse(text));
    } catch (const Json::parse_error& error) {
        return tl::unexpected("expected JSON, found an error at byte " + std::to_string(error.byte));
    } catch (const Json::out_of_range&) {
        return tl::unexpected(std::string("expected numbers in the range of double, found another"));
    } catch (const std::exception& error) {
        return tl::unexpected(std::string(error.what()));
    }
}

}  // namespace vrut
