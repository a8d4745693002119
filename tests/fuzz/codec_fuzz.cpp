#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "codec.hpp"
#include "state.hpp"
#include "state_document.hpp"
#include "tokens.hpp"

using namespace vrut::protocol;

namespace {

void check(bool holds) {
    if (!holds) std::abort();
}

const State& start() {
    static const State state = [] {
        State result;
        result.lights.items.set("headlight", {});
        result.backgrounds.items.set("1", {});
        result.views.set("home", {});
        return result;
    }();
    return state;
}

/// What is written is read as the same.
void round_trip(const ClientMessage& message) {
    const std::string text = encode(message);
    if (text.size() > kMaxMessageBytes) return;  // 1e9 was shorter
    const auto again = decode(text);
    check(again.has_value());
    check(encode(*again) == text);
}

void patch_state(const nlohmann::json& patch) {
    const auto first = StateDocument::next({}, start());
    first->last_change(patch);
    named_camera_members(patch);
    const auto next = patched(start(), start(), patch);
    if (!next) return check(next.error().message.size() <= 300);
    const auto second = StateDocument::next(*first, *next);
    nlohmann::json merged = first->json();
    merged.merge_patch(nlohmann::json::parse(second->encode_patch_from(*first, "c1"))["patch"]);
    check(merged == second->json());
    const auto back = restored(start(), second->json());
    check(back.has_value() && *back == *next);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    if (const auto message = decode(text)) {
        round_trip(*message);
        if (const auto* patch = std::get_if<Patch>(&message->payload)) patch_state(*patch->patch);
    } else {
        check(message.error().message.size() <= 300);
        encode(message.error());
    }
    static_cast<void>(parse_camera(text));
    static_cast<void>(parse_tokens(text));
    return 0;
}
