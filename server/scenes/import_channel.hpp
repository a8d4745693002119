#pragma once

namespace vrut::server::scenes {

/// What a process that reads a file has open. It writes doubles there: how far it is, from 0 to 1, and what
/// of enter_sandbox() it could not have; then kReady, then the parts (serialize_parts()).
inline constexpr int kChannel = 3;
inline constexpr double kReady = -1, kFilesOpen = -2, kCallsOpen = -3;

/// Its exit status where its memory does not suffice.
inline constexpr int kOutOfMemory = 3;

}  // namespace vrut::server::scenes
