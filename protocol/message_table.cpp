#include "message_table.hpp"

#include <algorithm>

namespace vrut::protocol {

namespace {

Pointer pointer(Pointer::Event event) {
    Pointer message;
    message.event = event;
    return message;
}

Key key(bool down) {
    Key message;
    message.down = down;
    return message;
}

std::vector<ClientMessageType> all_types() {
    using enum Senders;
    using enum Steers;
    using enum Weight;
    return {
        // clang-format off
    // type              senders           steers      recorded weight
    {{"hello",         all,              no,         false, request}, Hello{}},
    {{"resize",        all,              no,         true,  request}, Resize{}},
    {{"frame",         all,              no,         false, stream},  FrameGrant{}},
    {{"pointerdown",   control,          by_content, true,  stream},  pointer(Pointer::Event::down)},
    {{"pointermove",   control,          by_content, true,  stream},  pointer(Pointer::Event::move)},
    {{"pointerup",     control,          by_content, true,  stream},  pointer(Pointer::Event::up)},
    {{"pointercancel", control,          by_content, true,  stream},  pointer(Pointer::Event::cancel)},
    {{"wheel",         control,          yes,        true,  stream},  Wheel{}},
    {{"keydown",       control,          yes,        true,  stream},  key(true)},
    {{"keyup",         all,              no,         true,  stream},  key(false)},
    {{"navigate",      control,          yes,        true,  request}, Navigate{}},
    {{"fit",           control,          yes,        true,  request}, Fit{}},
    {{"swing",         control,          yes,        true,  request}, Swing{}},
    {{"patch",         control_and_host, by_content, true,  request}, Patch{}},
    {{"pick",          all,              by_content, true,  request}, Pick{}},
    {{"snapshot",      all,              no,         true,  request}, Snapshot{}},
    {{"fly",           control,          yes,        true,  request}, Fly{}},
    {{"cue",           control,          yes,        true,  request}, Cue{}},
    {{"check",         all,              no,         false, request}, Check{}},
    {{"tree",          all,              no,         true,  request}, Tree{}},
    {{"open",          control,          yes,        true,  request}, Open{}},
    {{"scenes",        all,              no,         true,  request}, Scenes{}},
    {{"record",        control,          yes,        true,  request}, Record{}},
    {{"control",       control,          no,         true,  request}, Control{}},
    {{"share",         control,          no,         false, request}, Share{}},
    {{"shown",         host,             no,         true,  request}, Shown{}},
    {{"point",         all,              no,         false, stream},  Point{}},
        // clang-format on
    };
}

/// Whether messages with these payloads have the same word in `type`.
bool are_of_one_type(const decltype(ClientMessage::payload)& a, const decltype(ClientMessage::payload)& b) {
    if (a.index() != b.index()) return false;
    if (const auto* pointer = std::get_if<Pointer>(&a)) return pointer->event == std::get<Pointer>(b).event;
    if (const auto* key = std::get_if<Key>(&a)) return key->down == std::get<Key>(b).down;
    return true;
}

}  // namespace

std::span<const ClientMessageType> client_message_types() {
    static const std::vector<ClientMessageType> types = all_types();
    return types;
}

const MessageTraits& traits_of(const ClientMessage& message) {
    return std::ranges::find_if(client_message_types(),
                                [&](const ClientMessageType& type) {
                                    return are_of_one_type(message.payload, type.prototype);
                                })
        ->traits;
}

}  // namespace vrut::protocol
