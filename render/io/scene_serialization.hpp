#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "io/read_scene.hpp"

namespace vrut::io {

/// Receives the bytes of a stream, block by block.
using ByteSink = std::function<void(std::string_view)>;
/// Reads `size` bytes of a stream into `to`, or throws.
using ByteSource = std::function<void(void* to, std::size_t size)>;

/// Serializes a reader's result for another process of the same program: 64-bit words in native byte order,
/// preceded by their count.
void serialize_parts(PartsResult parts, const ByteSink& sink);

/// Deserializes. The bytes are untrusted: returns an error if they are not valid parts of a reader of `file`
/// or announce more than `most` bytes. Uses at most the announced memory, and less than 5 times the received
/// bytes. Propagates what `source` throws.
PartsResult deserialize_parts(const ByteSource& source, std::uint64_t most, const std::string& file);

}  // namespace vrut::io
