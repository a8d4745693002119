#include <cstdint>
#include <cstdlib>

#include "event_log.hpp"

using namespace vrut::protocol;

namespace {

/// What is written is read as the same.
template <class Decode>
void round_trip(std::string_view text, Decode decode) {
    const auto value = decode(text);
    if (!value) {
        if (value.error().message.empty() || value.error().message.size() > 300) std::abort();
        return;
    }
    const std::string written = encode(*value);
    const auto again = decode(written);
    if (!again || encode(*again) != written) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    round_trip(text, decode_log_header);
    round_trip(text, decode_log_line);
    return 0;
}
