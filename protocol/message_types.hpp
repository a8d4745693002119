#pragma once

#include "messages.hpp"

/// Which word in `type` stands for which message. For protocol's own .cpp files.
namespace vrut::protocol {

/// Calls `use(name, message)` for each type of client message; `message` is of that type and holds what the
/// name itself says.
template <class Use>
void for_each_client_type(Use use) {
    const auto pointer = [](Pointer::Event event) {
        Pointer message;
        message.event = event;
        return message;
    };
    const auto key = [](bool down) {
        Key message;
        message.down = down;
        return message;
    };
    use("hello", Hello{});
    use("resize", Resize{});
    use("frame", FrameGrant{});
    use("pointerdown", pointer(Pointer::Event::down));
    use("pointermove", pointer(Pointer::Event::move));
    use("pointerup", pointer(Pointer::Event::up));
    use("pointercancel", pointer(Pointer::Event::cancel));
    use("wheel", Wheel{});
    use("keydown", key(true));
    use("keyup", key(false));
    use("navigate", Navigate{});
    use("fit", Fit{});
    use("patch", Patch{});
    use("pick", Pick{});
    use("snapshot", Snapshot{});
    use("fly", Fly{});
    use("tree", Tree{});
    use("open", Open{});
    use("scenes", Scenes{});
    use("record", Record{});
    use("control", Control{});
    use("shown", Shown{});
}

/// Whether two messages of one struct go by the same name.
template <class Message>
bool same_type(const Message&, const Message&) {
    return true;
}
inline bool same_type(const Pointer& a, const Pointer& b) { return a.event == b.event; }
inline bool same_type(const Key& a, const Key& b) { return a.down == b.down; }

inline const char* type_of(const decltype(ClientMessage::payload)& payload) {
    const char* type = "";
    for_each_client_type([&](const char* name, const auto& prototype) {
        const auto* message = std::get_if<std::decay_t<decltype(prototype)>>(&payload);
        if (message && same_type(*message, prototype)) type = name;
    });
    return type;
}

}  // namespace vrut::protocol
