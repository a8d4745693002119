#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mesh/picking_trees.hpp"
#include "messages.hpp"
#include "scene/scene.hpp"

namespace vrut::server::scenes {

/// A scene as it was read.
struct LoadedScene {
    std::string name;    ///< by which it was asked for
    std::string sha256;  ///< of its file, in hexadecimal
    std::shared_ptr<const scene::PlacedScene> placed;
    std::vector<protocol::Notice> notices;
    /// A patch of the state that is laid over what the file says (stored_changes()); empty: none.
    std::string changes = {};
    /// Why those that are kept cannot be used, in words that end a sentence; none: they can.
    std::optional<std::string> changes_fault = {};
    std::shared_ptr<const mesh::PickingTrees> picking_trees = {};  ///< null: picks take longer
    std::optional<protocol::UpAxis> up_axis = {};  ///< in use, if the format does not define it

    /// The key of its kept changes: its hash, and the up axis if that is z, since points and matrices of the
    /// two do not fit each other.
    std::string changes_key() const;
};

/// What the reader reported about a scene, and which of its features are not drawn.
std::vector<protocol::Notice> all_notices(const scene::PlacedScene& placed);

/// An upper bound of the bytes that cameras, lights, materials, backgrounds and notices take in `state`.
std::size_t most_state_bytes(const LoadedScene& scene);
/// A scene with a larger bound is rejected, since clients get the state in one message. The other 8 MiB are
/// for what clients change.
inline constexpr std::size_t kMaxStateBytes = protocol::kMaxServerMessageBytes - (std::size_t{8} << 20);

}  // namespace vrut::server::scenes
