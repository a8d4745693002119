#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "measurement/mesh_edges.hpp"
#include "mesh/picking.hpp"
#include "room/seen_frames.hpp"
#include "scene/scene.hpp"
#include "server_messages.hpp"
#include "state.hpp"

namespace vrut::server::room {

/// What picks snap to, and what measures come to as the parts stand.
class Measures {
public:
    using Hit = std::function<std::optional<mesh::Hit>(const mesh::Ray& ray)>;

    /// What a pick with `snap` finds in what `seen` shows; none where nothing is near. `hit`: what lies along
    /// a ray.
    std::optional<protocol::Snapped> snapped(const scene::PlacedScene& placed, const SeenFrame& seen,
                                             const protocol::Pick& pick, const Hit& hit,
                                             std::span<const scene::ClipPlane> clip_planes) const;
    /// What is wrong with measures in this scene.
    static std::optional<protocol::Error> problem_of(
        const protocol::SharedMap<protocol::MeasureState>& measures, const scene::Scene& scene);
    using Results = std::map<std::string, protocol::MeasuredState>;
    /// What they come to; none: the same as at the last call.
    std::optional<Results> changed(const protocol::SharedMap<protocol::MeasureState>& measures,
                                   const std::shared_ptr<const scene::PlacedScene>& placed);
    /// Another scene comes.
    void forget_edges() { edges_ = {}; }

private:
    protocol::SharedMap<protocol::MeasureState> measures_;  ///< of the last call
    std::shared_ptr<const scene::PlacedScene> placed_;      ///< likewise
    mutable measurement::MeshEdgesMemo edges_;
};

}  // namespace vrut::server::room
