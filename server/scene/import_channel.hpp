#pragma once

namespace vrut::server::scene {

/// What a process that reads a file has open. It writes there how far it is, in doubles from 0 to 1, then
/// kReady, then the parts (write_parts()).
inline constexpr int kChannel = 3;
inline constexpr double kReady = -1;

/// Its exit status where its memory does not suffice.
inline constexpr int kOutOfMemory = 3;

}  // namespace vrut::server::scene
