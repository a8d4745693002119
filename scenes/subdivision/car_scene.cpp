#include "car_scene.hpp"

#include <algorithm>
#include <atomic>
#include <deque>
#include <future>
#include <map>
#include <set>
#include <stdexcept>

#include "cut.hpp"
#include "refinement.hpp"
#include "sheet.hpp"
#include "shell.hpp"

namespace vrut {

namespace {

std::string name_of(const scene::Node& node) {
    return "node " + std::to_string(node.id) + " \"" + node.name + "\"";
}

/// The tree alone, to see which nodes show.
scene::Scene tree_of(const CageScene& cages) {
    scene::SceneParts parts;
    parts.materials = cages.materials;
    for (const CageNode& node : cages.nodes) parts.nodes.push_back(node.part);
    auto scene = scene::Scene::build(std::move(parts));
    if (!scene) throw std::runtime_error(scene.error().message);
    return *std::move(scene);
}

/// Ids of the nodes that show at first.
std::map<scene::Id, bool> shown_ids(const scene::Scene& scene) {
    std::vector<bool> shown(scene.nodes().size(), true);
    std::map<scene::Id, bool> result;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const scene::Node& node = scene.nodes()[i];
        shown[i] = shown[i] && node.active;
        result[node.id] = shown[i];
        for (std::size_t k = 0; k < node.children.size(); ++k) {
            bool chosen = shown[i];
            if (const auto* data = std::get_if<scene::SwitchData>(&node.data); data != nullptr)
                chosen = chosen && (data->active_child == scene::SwitchData::kAllChildren ||
                                    data->active_child == static_cast<int>(k));
            if (node.type == scene::NodeType::lod) chosen = chosen && k == 0;
            shown[static_cast<std::size_t>(node.children[k])] = chosen;
        }
    }
    return result;
}

/// Refined where the surface bends, where an outline does, and where strips between outlines are narrow; not
/// inside holes.
class SkinRule {
public:
    SkinRule(const std::vector<CutShape>& cuts, std::vector<bool> kept, bool rest_kept, double margin)
        : cuts_(cuts), kept_(std::move(kept)), rest_kept_(rest_kept), margin_(margin) {}

    double of_edge(const glm::dvec3& a, const glm::dvec3& b, double curvature) const {
        const Place place = place_of((a + b) / 2.0, glm::distance(a, b) / 2);
        if (place.crossed.empty()) return place.kept ? curvature : 0;
        double error = curvature;
        for (const std::size_t i : place.crossed)
            error = std::max(error, kOutline * outline_bend(cuts_[i], a, b));
        if (place.crossed.size() > 1 && skips_a_piece(place.crossed, a, b))
            error = std::max(error, kSkipped * glm::distance(a, b));
        return error;
    }

    double of_triangle(const std::array<glm::dvec3, 3>& corners) const {
        const glm::dvec3 centre = (corners[0] + corners[1] + corners[2]) / 3.0;
        double radius = 0;
        for (const glm::dvec3& corner : corners) radius = std::max(radius, glm::distance(centre, corner));
        if (radius <= kCorner) return 0;
        const Place place = place_of(centre, radius);
        if (place.crossed.size() < 2 || !has_a_corner(place.crossed, corners, centre)) return 0;
        return kSkipped * (radius - kCorner);
    }

private:
    static constexpr double kOutline = 1.5;  // how much more an outline's error shows than the surface's
    static constexpr double kCorner = 0.02;  // metres; a smaller hole where three pieces meet does not show
    static constexpr double kEverywhere = 1e9;
    static constexpr double kSkipped = 0.5;  // of an edge: the error where it jumps across a strip
    static constexpr int kRest = -1, kGap = -2;

    double half_gap(std::size_t i) const { return cuts_[i].gap() / 2 + margin_; }
    double distance(std::size_t i, const glm::dvec3& p) const { return cuts_[i].at(p, kEverywhere).value; }

    /// The cuts whose outlines may cross a ball; without any, whether a panel is made of what it is in.
    struct Place {
        std::vector<std::size_t> crossed;
        bool kept = false;
    };
    Place place_of(const glm::dvec3& centre, double radius) const {
        Place place{{}, rest_kept_};
        for (std::size_t i = 0; i < cuts_.size(); ++i) {
            const double reach = radius + 2 * half_gap(i);
            const double distance = cuts_[i].at(centre, reach).value;
            if (distance < -reach) {
                place.kept = kept_[i];
                break;
            }
            if (distance <= reach) place.crossed.push_back(i);
        }
        return place;
    }

    /// How far an outline could be from a straight line beside an edge.
    static double outline_bend(const CutShape& cut, const glm::dvec3& a, const glm::dvec3& b) {
        const auto value = [&](const glm::dvec3& p) { return cut.at(p, kEverywhere).value; };
        return std::abs(value((a + b) / 2.0) - (value(a) + value(b)) / 2);
    }

    /// Which cut's piece a point belongs to, or kRest, or kGap.
    int piece_at(const std::vector<std::size_t>& crossed, const glm::dvec3& p) const {
        for (const std::size_t i : crossed) {
            const double value = distance(i, p);
            if (value < -half_gap(i)) return static_cast<int>(i);
            if (value <= half_gap(i)) return kGap;
        }
        return kRest;
    }

    /// Whether three pieces meet in a triangle: marching over it would leave a hole between them.
    bool has_a_corner(const std::vector<std::size_t>& crossed, const std::array<glm::dvec3, 3>& corners,
                      const glm::dvec3& centre) const {
        std::set<int> pieces;
        for (const glm::dvec3& p : {corners[0], corners[1], corners[2], centre})
            if (const int piece = piece_at(crossed, p); piece != kGap) pieces.insert(piece);
        return pieces.size() > 2;
    }

    /// Whether an edge from a to b leads over a whole piece, so that neither end would tell of it.
    bool skips_a_piece(const std::vector<std::size_t>& crossed, const glm::dvec3& a,
                       const glm::dvec3& b) const {
        std::vector<double> places = {0, 1};
        for (const std::size_t i : crossed) {
            const double at_a = distance(i, a), at_b = distance(i, b);
            for (const double level : {-half_gap(i), half_gap(i)})
                if ((at_a < level) != (at_b < level)) places.push_back((level - at_a) / (at_b - at_a));
        }
        if (places.size() < 4) return false;
        std::sort(places.begin(), places.end());
        std::vector<int> pieces;
        for (std::size_t k = 0; k + 1 < places.size(); ++k) {
            if (places[k + 1] - places[k] < 1e-7) continue;
            const int piece = piece_at(crossed, glm::mix(a, b, (places[k] + places[k + 1]) / 2));
            if (pieces.empty() || pieces.back() != piece) pieces.push_back(piece);
        }
        return pieces.size() > 3 || (pieces.size() == 3 && (pieces[1] != kGap || pieces[0] == pieces[2]));
    }

    const std::vector<CutShape>& cuts_;
    std::vector<bool> kept_;  // for each cut, whether a panel is made of it
    bool rest_kept_;
    double margin_;
};

/// A geometry of the result: of a mesh, or of a panel of one node.
struct BodyPart {
    int mesh = scene::kNone;
    const CageNode* panel = nullptr;
    double uses = 0;  // shown nodes that have it
    scene::Geometry geometry;
};

/// A skin that is in use, with its panels.
struct SkinInWork {
    std::vector<CutShape> cuts;
    std::vector<BodyPart*> panels;
    std::size_t refined = 0;  // its place among the refined
};

class Subdivision {
public:
    Subdivision(CageScene cages, double triangles)
        : cages_(std::move(cages)),
          asked_(triangles),
          tree_(tree_of(cages_)),
          shown_(shown_ids(tree_)),
          world_(scene::world_matrices(tree_, scene::file_states(tree_))) {
        for (const CageNode& node : cages_.nodes) by_id_[node.part.node.id] = &node;
        for (const CageNode& node : cages_.nodes) add_use(node);
        for (auto& [number, skin] : skins_) add_skin(number, skin);
    }

    SubdividedScene run() {
        Refinement refinement(refined_);
        // How many triangles a skin's panels make is known when they have been made; what each of a skin's
        // triangles makes falls slowly as they get smaller.
        const auto refine_to = [&](double count) {
            refinement.refine_to(count);
            make_panels(refinement.reached());
        };
        for (const double share : {0.2, 0.9}) refine_to(share * asked_);
        for (int step = 0; step < 10 && refinement.count() < 0.98 * asked_; ++step) {
            const double missing = asked_ - refinement.count();
            refine_to(refinement.count() + (asked_ < kFew ? 0.4 * missing + 0.005 * asked_ : missing));
        }
        for (BodyPart& part : parts_)
            if (part.mesh != scene::kNone) {
                const bool textured = !cages_.meshes[static_cast<std::size_t>(part.mesh)].texcoords.empty();
                part.geometry = geometry_of(*refined_[part_of_mesh_.at(part.mesh).second].mesh, textured);
            }
        SubdividedScene result;
        result.tolerance = refinement.reached();
        for (const BodyPart& part : parts_) {
            result.shown += part.uses * static_cast<double>(part.geometry.triangles.size());
            result.vertices += static_cast<double>(part.geometry.positions.size());
        }
        result.lost = lost();
        result.scene = assemble();
        return result;
    }

private:
    /// Where the node's geometry comes from; null where it has none.
    const CageNode* source_of(const CageNode& node) const {
        const CageNode& source = node.geometry_of ? *by_id_.at(*node.geometry_of) : node;
        return source.mesh != scene::kNone || source.panel ? &source : nullptr;
    }

    void add_use(const CageNode& node) {
        const CageNode* source = source_of(node);
        if (source == nullptr) return;
        BodyPart& part = source->panel ? panel_part(*source) : mesh_part(source->mesh);
        const double use = shown_.at(node.part.node.id) ? 1 : 0;
        part.uses += use;
        if (source->panel) return;
        RefinedPart& refined = refined_[part_of_mesh_.at(source->mesh).second];
        refined.weight += use;
        if (!node.geometry_of) refined.tolerance = std::min(refined.tolerance, node.tolerance);
    }

    BodyPart& mesh_part(int mesh) {
        const auto found = part_of_mesh_.find(mesh);
        if (found != part_of_mesh_.end()) return *found->second.first;
        BodyPart& part = parts_.emplace_back();
        part.mesh = mesh;
        part_of_mesh_[mesh] = {&part, refined_.size()};
        meshes_.emplace_back(cages_.meshes[static_cast<std::size_t>(mesh)]);
        refined_.push_back({&meshes_.back(), kAnyTolerance, 0});
        return part;
    }

    BodyPart& panel_part(const CageNode& node) {
        BodyPart*& part = part_of_panel_[node.part.node.id];
        if (part == nullptr) {
            part = &parts_.emplace_back();
            part->panel = &node;
            skins_[node.panel->skin].panels.push_back(part);
        }
        return *part;
    }

    void add_skin(int number, SkinInWork& skin) {
        const Skin& description = cages_.skins[static_cast<std::size_t>(number)];
        for (const Cut& cut : description.cuts) skin.cuts.emplace_back(cut);
        std::vector<bool> kept(skin.cuts.size());
        bool rest_kept = false;
        double margin = 0, tolerance = kAnyTolerance, uses = 0;
        for (const BodyPart* part : skin.panels) {
            const Panel& panel = *part->panel->panel;
            if (const scene::Node& node = part->panel->part.node; !scene::is_finite(from_car(node)))
                throw std::runtime_error(name_of(node) + ": its place in the car has no inverse");
            if (panel.cut == scene::kNone)
                rest_kept = true;
            else
                kept[static_cast<std::size_t>(panel.cut)] = true;
            margin = std::max(margin, panel.edge);
            tolerance = std::min(tolerance, part->panel->tolerance);
            uses += part->uses;
        }
        const SkinRule rule(skin.cuts, std::move(kept), rest_kept, margin);
        meshes_.emplace_back(
            cages_.meshes[static_cast<std::size_t>(description.mesh)],
            AdaptiveMesh::ErrorRule{[rule](const auto& a, const auto& b, double curvature) {
                                        return rule.of_edge(a, b, curvature);
                                    },
                                    [rule](const auto& corners) { return rule.of_triangle(corners); }});
        skin.refined = refined_.size();
        refined_.push_back({&meshes_.back(), tolerance, uses > 0 ? 2.2 : 0});
    }

    void make_panels(double tolerance) {
        for (auto& [number, skin] : skins_) {
            RefinedPart& refined = refined_[skin.refined];
            const CuttingTable table(*refined.mesh);
            const Skin& description = cages_.skins[static_cast<std::size_t>(number)];
            const bool textured =
                !cages_.meshes[static_cast<std::size_t>(description.mesh)].texcoords.empty();
            std::atomic<std::size_t> next = 0;
            const auto make_some = [&, &skin = skin] {
                for (std::size_t i = next++; i < skin.panels.size(); i = next++)
                    make_panel(*skin.panels[i], skin, table, tolerance * refined.tolerance, textured);
            };
            auto others = std::async(std::launch::async, make_some);
            make_some();
            others.get();
            double count = 0;
            for (const BodyPart* part : skin.panels)
                count += part->uses * static_cast<double>(part->geometry.triangles.size());
            refined.weight = count / static_cast<double>(refined.mesh->triangles().size());
        }
    }

    void make_panel(BodyPart& part, const SkinInWork& skin, const CuttingTable& table, double tolerance,
                    bool textured) const {
        Panel panel = *part.panel->panel;
        if (tolerance > kRoundest * panel.edge) panel.edge = 0;
        const PanelField field(skin.cuts, panel.cut, panel.edge, panel.grow);
        const Sheet sheet = cut_out(*refined_[skin.refined].mesh, table,
                                    [&](const glm::dvec3& p, const glm::dvec3& n) { return field.at(p, n); });
        part.geometry = shell_of(sheet, panel, tolerance, from_car(part.panel->part.node), textured);
    }

    glm::dmat4 from_car(const scene::Node& node) const {
        return glm::inverse(world_[static_cast<std::size_t>(tree_.find_node(node.id))]);
    }

    std::vector<std::string> lost() const {
        std::vector<std::string> names;
        for (const CageNode& node : cages_.nodes) {
            const bool has_own = node.mesh != scene::kNone || node.panel;
            if (has_own && part_of(node).geometry.triangles.empty()) names.push_back(name_of(node.part.node));
        }
        return names;
    }

    /// Of a node that has a geometry.
    const BodyPart& part_of(const CageNode& node) const {
        const CageNode& source = *source_of(node);
        return source.panel ? *part_of_panel_.at(source.part.node.id) : *part_of_mesh_.at(source.mesh).first;
    }

    scene::Scene assemble() {
        scene::SceneParts result;
        result.unit = 1;  // cages are in metres
        result.materials = cages_.materials;
        std::map<const BodyPart*, scene::Index> place;
        for (BodyPart& part : parts_) {
            place[&part] = static_cast<scene::Index>(result.geometries.size());
            result.geometries.push_back(std::move(part.geometry));
            result.geometries.back().id = static_cast<scene::Id>(result.geometries.size());
        }
        for (const CageNode& node : cages_.nodes) {
            result.nodes.push_back(node.part);
            if (source_of(node) == nullptr) continue;
            std::get<scene::GeometryData>(result.nodes.back().node.data).geometry = place.at(&part_of(node));
        }
        auto scene = scene::Scene::build(std::move(result));
        if (!scene) throw std::runtime_error(scene.error().message);
        return *std::move(scene);
    }

    static constexpr double kAnyTolerance = 1e9;
    static constexpr double kFew = 1e5;     // triangles: a step adds less, as roundings come in leaps
    static constexpr double kRoundest = 8;  // of an edge's radius: where more is permitted, it is not rounded

    CageScene cages_;
    double asked_;
    scene::Scene tree_;
    std::map<scene::Id, bool> shown_;
    std::vector<glm::dmat4> world_;
    std::map<scene::Id, const CageNode*> by_id_;
    std::deque<BodyPart> parts_;
    std::deque<AdaptiveMesh> meshes_;
    std::vector<RefinedPart> refined_;
    std::map<int, std::pair<BodyPart*, std::size_t>> part_of_mesh_;  // and its place among the refined
    std::map<scene::Id, BodyPart*> part_of_panel_;
    std::map<int, SkinInWork> skins_;
};

/// The node stays, as a group: its name and number are what scripts and logs use.
void leave_out(CageNode& node) {
    node.part.node.type = scene::NodeType::assembly;
    node.part.node.data = {};
    node.mesh = scene::kNone;
    node.panel = {};
    node.geometry_of = {};
}

/// Without the parts and the cuts that are too fine for so many triangles. What a cut would have taken goes
/// to its neighbours.
CageScene without_detail(CageScene cages, double triangles) {
    std::vector<std::vector<int>> place_of_cut;
    for (Skin& skin : cages.skins) {
        std::vector<int>& places = place_of_cut.emplace_back();
        std::vector<Cut> kept;
        for (Cut& cut : skin.cuts) {
            const bool fine = cut.detail > triangles;
            places.push_back(fine ? scene::kNone : static_cast<int>(kept.size()));
            if (!fine) kept.push_back(std::move(cut));
        }
        skin.cuts = std::move(kept);
    }
    std::set<scene::Id> left_out;
    for (CageNode& node : cages.nodes) {
        bool fine = node.detail > triangles;
        if (node.panel && node.panel->cut != scene::kNone) {
            int& cut = node.panel->cut;
            cut = place_of_cut[static_cast<std::size_t>(node.panel->skin)][static_cast<std::size_t>(cut)];
            fine = fine || cut == scene::kNone;
        }
        if (!fine) continue;
        left_out.insert(node.part.node.id);
        leave_out(node);
    }
    for (CageNode& node : cages.nodes)
        if (node.geometry_of && left_out.contains(*node.geometry_of)) leave_out(node);
    return cages;
}

}  // namespace

tl::expected<SubdividedScene, std::string> subdivide(const CageScene& cages, double triangles) {
    try {
        return Subdivision(without_detail(cages, triangles), triangles).run();
    } catch (const std::exception& error) {
        return tl::unexpected(std::string(error.what()));
    }
}

}  // namespace vrut
