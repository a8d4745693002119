#include <cstdint>

#include "codec.hpp"
#include "state.hpp"
#include "tokens.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vrut::protocol;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    State state;
    state.lights.items["headlight"] = {};
    state.backgrounds.items["1"] = {};
    if (const auto message = decode(text)) {
        if (const auto* patch = std::get_if<Patch>(&message->payload)) {
            const auto first = StateDocument::next({}, state);
            if (const auto next = patched(state, state, *patch->patch))
                StateDocument::next(*first, *next)->encode_patch_from(*first, "c1");
            first->last_change(*patch->patch);
        }
    } else {
        encode(message.error());
    }
    static_cast<void>(parse_camera(text, state.camera));
    static_cast<void>(parse_tokens(text));
    return 0;
}
