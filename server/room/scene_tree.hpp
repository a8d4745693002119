#pragma once

#include <tl/expected.hpp>

#include "messages.hpp"
#include "scene/scene.hpp"
#include "server_messages.hpp"

namespace vrut::server::room {

/// A page of the tree, depth first: the nodes at and below one, down to a depth, or those of them whose names
/// hold what is searched for. A page costs a bounded amount of work: it may be short, or empty, and still
/// have a next one. `id` is left to the caller.
tl::expected<protocol::TreePage, protocol::Error> tree_page(const scene::PlacedScene& placed,
                                                            const protocol::Tree& tree);

}  // namespace vrut::server::room
