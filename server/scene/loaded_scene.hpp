#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scene.hpp"

namespace vrut::server::scene {

/// A scene as it was read.
struct LoadedScene {
    std::string name;    ///< by which it was asked for
    std::string sha256;  ///< of its file, in hexadecimal
    std::shared_ptr<const PlacedScene> placed;
    std::vector<std::string> notices;
};

/// What the reader reported about a scene, and which of its features are not drawn.
std::vector<std::string> all_notices(const Scene& scene);

}  // namespace vrut::server::scene
