#include <cstdint>
#include <cstdlib>

#include "net/http_request.hpp"

using namespace vrut;
using namespace vrut::server::net;

namespace {

void check(bool holds) {
    if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    const auto read = read_request(bytes);
    if (!read) {
        check(size < kMaxRequest);
        return 0;
    }
    if (!*read) {
        check(!read->error().sentence.empty() && static_cast<int>(read->error().status) >= 400);
        return 0;
    }
    const auto& [request, length] = **read;
    check(length <= kMaxRequest && length <= size);
    check(request.target().starts_with("/") && request.payload_size().value_or(0) == 0);
    // It neither depends on what comes behind it, nor is judged before it is all there.
    check(read_request(bytes.substr(0, length)).has_value());
    for (std::size_t cut = length / 4; cut < length; cut += length / 4 + 1)
        check(!read_request(bytes.substr(0, cut)).has_value());
    return 0;
}
