#pragma once

#include <functional>
#include <string>
#include <vector>

#include "plan/view.hpp"

namespace vrut {

/// The same picture from another scene.
struct SceneVariant {
    std::string name;
    plan::View view;
    scene::Id ids =
        1;  ///< by this its nodes' ids are divided to get those of the scene that it was made from
};

/// The view's scene at other sizes and places, mirrored twice, turned once around, in another order, and with
/// each mesh split in two. The scene stands as its file says.
std::vector<SceneVariant> variants_of(const plan::View& view);

}  // namespace vrut
