#pragma once

#include <cstddef>

namespace vrut::server::net {

/// Makes sure that this process may have so many files and sockets open. Throws std::runtime_error where the
/// system does not let it.
void allow_descriptors(std::size_t needed);

}  // namespace vrut::server::net
