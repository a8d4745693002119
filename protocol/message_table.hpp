#pragma once

#include "messages.hpp"

/// The one table of client messages. A new type of message is a struct with its members (messages.hpp,
/// descriptions.hpp), a row here, and the room's handler, Room::apply() of that struct.
namespace vrut::protocol {

/// The roles that may send a message.
enum class Senders { all, control_and_host, control, host };

/// If a message steers: its client must hold control, or takes it. `by_content`: its handler tells.
enum class Steers { no, yes, by_content };

/// What a message weighs of what a client may have unhandled. Thousands a second come of a stream, pointer
/// moves and grants; their bytes count, not their number.
enum class Weight { stream, request };

struct MessageTraits {
    const char* type;  ///< the word in `type`
    Senders senders;
    Steers steers;
    bool recorded;  ///< an accepted one is a line of the event log
    Weight weight;
};

/// Calls `use(traits, message)` for each type of client message; `message` is of the type's struct and holds
/// what the type itself says.
template <class Use>
void for_each_client_type(Use use) {
    using enum Senders;
    using enum Steers;
    using enum Weight;
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
    // clang-format off
    //                type              senders           steers      recorded weight
    use(MessageTraits{"hello",         all,              no,         false, request}, Hello{});
    use(MessageTraits{"resize",        all,              no,         true,  request}, Resize{});
    use(MessageTraits{"frame",         all,              no,         false, stream},  FrameGrant{});
    use(MessageTraits{"pointerdown",   control,          by_content, true,  stream},  pointer(Pointer::Event::down));
    use(MessageTraits{"pointermove",   control,          by_content, true,  stream},  pointer(Pointer::Event::move));
    use(MessageTraits{"pointerup",     control,          by_content, true,  stream},  pointer(Pointer::Event::up));
    use(MessageTraits{"pointercancel", control,          by_content, true,  stream},  pointer(Pointer::Event::cancel));
    use(MessageTraits{"wheel",         control,          yes,        true,  stream},  Wheel{});
    use(MessageTraits{"keydown",       control,          yes,        true,  stream},  key(true));
    use(MessageTraits{"keyup",         all,              no,         true,  stream},  key(false));
    use(MessageTraits{"navigate",      control,          yes,        true,  request}, Navigate{});
    use(MessageTraits{"fit",           control,          yes,        true,  request}, Fit{});
    use(MessageTraits{"swing",         control,          yes,        true,  request}, Swing{});
    use(MessageTraits{"patch",         control_and_host, by_content, true,  request}, Patch{});
    use(MessageTraits{"pick",          all,              by_content, true,  request}, Pick{});
    use(MessageTraits{"snapshot",      all,              no,         true,  request}, Snapshot{});
    use(MessageTraits{"fly",           control,          yes,        true,  request}, Fly{});
    use(MessageTraits{"cue",           control,          yes,        true,  request}, Cue{});
    use(MessageTraits{"check",         all,              no,         false, request}, Check{});
    use(MessageTraits{"tree",          all,              no,         true,  request}, Tree{});
    use(MessageTraits{"open",          control,          yes,        true,  request}, Open{});
    use(MessageTraits{"scenes",        all,              no,         true,  request}, Scenes{});
    use(MessageTraits{"record",        control,          yes,        true,  request}, Record{});
    use(MessageTraits{"control",       control,          no,         true,  request}, Control{});
    use(MessageTraits{"share",         control,          no,         false, request}, Share{});
    use(MessageTraits{"shown",         host,             no,         true,  request}, Shown{});
    use(MessageTraits{"point",         all,              no,         false, stream},  Point{});
    // clang-format on
}

/// Whether two messages of one struct are of the same type.
template <class Message>
bool same_type(const Message&, const Message&) {
    return true;
}
inline bool same_type(const Pointer& a, const Pointer& b) { return a.event == b.event; }
inline bool same_type(const Key& a, const Key& b) { return a.down == b.down; }

inline MessageTraits traits_of(const ClientMessage& message) {
    MessageTraits found{};
    for_each_client_type([&](const MessageTraits& traits, const auto& prototype) {
        const auto* same = std::get_if<std::decay_t<decltype(prototype)>>(&message.payload);
        if (same && same_type(*same, prototype)) found = traits;
    });
    return found;
}

}  // namespace vrut::protocol
