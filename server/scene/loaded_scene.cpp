#include "scene/loaded_scene.hpp"

#include "frame_plan.hpp"

namespace vrut::server::scene {

std::vector<std::string> all_notices(const Scene& scene) {
    std::vector<std::string> notices = scene.notices();
    for (std::string& notice : undrawn_features(scene)) notices.push_back(std::move(notice));
    return notices;
}

}  // namespace vrut::server::scene
