#pragma once

#include <tl/expected.hpp>

#include "frame_header.hpp"
#include "mesh/picking_trees.hpp"
#include "messages.hpp"
#include "navigation/camera_moves.hpp"
#include "navigation/flight.hpp"
#include "plan/view.hpp"
#include "scene/scene.hpp"
#include "scenes/loaded_scene.hpp"
#include "state.hpp"

namespace vrut::server::room {

/// The state of a scene as its file says, its camera at home for a view of `aspect`.
protocol::State starting_state(const scenes::LoadedScene& loaded, double aspect,
                               const navigation::Cover& cover = {});
/// The pose with which a scene opens: its first camera node's, or else the scene fitted to the view. `trees`
/// change the time that it takes; null: none.
protocol::Pose home_pose(const scene::PlacedScene& placed, double aspect, const navigation::Cover& cover,
                         const mesh::PickingTrees* trees);
/// What is shown at and below a node, less what presents it, and what planes cut away unless that is all.
navigation::FitTarget fit_target(const scene::PlacedScene& placed, scene::Index node,
                                 const mesh::PickingTrees* trees,
                                 std::span<const scene::ClipPlane> clip_planes = {});

scene::Camera camera_of(const protocol::Pose& pose);
protocol::Pose pose_of(const scene::Camera& camera);
/// Near and far are refitted to the scene; the camera stands at no node.
protocol::CameraState state_of(const scene::Camera& camera, const math::Bounds& bounds);
/// The same at camera node `node`.
protocol::CameraState state_at_node(const scene::Camera& camera, const scene::PlacedScene& placed,
                                    scene::Index node);

/// The camera of a camera node where it is now, or what is wrong with `node`. `what` names the culprit.
tl::expected<scene::Camera, protocol::Error> node_camera(const scene::PlacedScene& placed, scene::Id node,
                                                         const std::string& what);
/// `base` with the members of `overlay`, a valid pose with orthogonal up, or what is wrong; where `up` is not
/// given the roll of `base` is kept.
tl::expected<scene::Camera, protocol::Error> overlaid(const scene::Camera& base,
                                                      const protocol::CameraOverlay& overlay,
                                                      const scene::PlacedScene& placed,
                                                      const std::string& what);

/// The path of a flight that begins at `from`, or what is wrong with a keyframe: each is laid over the one
/// before, the first over `from`.
tl::expected<navigation::CameraPath, protocol::Error> flight_path(const protocol::Fly& fly,
                                                                  const scene::Camera& from,
                                                                  const scene::PlacedScene& placed);

/// A node by its id as a member's name; kNone where there is none.
scene::Index find_node(const scene::Scene& scene, const std::string& key);

/// How many of its nodes are solid, transparent and reflective, into the state.
void count_classes(protocol::State& state, const scene::PlacedScene& placed);

/// The states of a scene's nodes with `overrides`, or what is wrong with those. What equals the file's
/// disappears from `overrides`.
tl::expected<std::vector<scene::NodeState>, protocol::Error> node_states(
    const scene::Scene& scene, protocol::SharedMap<protocol::NodeOverride>& overrides);

/// All that is wrong with `overrides`, an error for each node.
std::vector<protocol::Error> node_problems(const scene::Scene& scene,
                                           const protocol::SharedMap<protocol::NodeOverride>& overrides);

/// The signs of `markers`, in world space; of those whose node shows and that lie within the range of double.
std::vector<plan::PlacedMarker> markers_of(const std::map<std::string, protocol::Marker>& markers,
                                           const scene::PlacedScene& placed);
/// What of the state and the scene is to be seen, but for size, samples and marks. The background is the
/// active one, if it is shown, else the plain colour.
plan::View view_of(const protocol::State& state, std::shared_ptr<const scene::PlacedScene> placed);
/// What a picture says of itself, but for its number, revision, quality and times.
protocol::FrameHeader header_of(const protocol::State& state, const plan::View& view,
                                const protocol::Resize& view_size);

}  // namespace vrut::server::room
