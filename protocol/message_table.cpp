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
    using enum Right;
    using enum Steers;
    using enum Weight;
    return {
        // clang-format off
    // type              right          steers      recorded weight
    {{"hello",         look,         no,         false, request}, Hello{}},
    {{"resize",        look,         no,         true,  request}, Resize{}},
    {{"frame",         look,         no,         false, stream},  FrameGrant{}},
    {{"pointerdown",   hold_control, by_content, true,  stream},  pointer(Pointer::Event::down)},
    {{"pointermove",   hold_control, by_content, true,  stream},  pointer(Pointer::Event::move)},
    {{"pointerup",     hold_control, by_content, true,  stream},  pointer(Pointer::Event::up)},
    {{"pointercancel", hold_control, by_content, true,  stream},  pointer(Pointer::Event::cancel)},
    {{"wheel",         hold_control, yes,        true,  stream},  Wheel{}},
    {{"keydown",       hold_control, yes,        true,  stream},  key(true)},
    {{"keyup",         look,         no,         true,  stream},  key(false)},
    {{"navigate",      hold_control, yes,        true,  request}, Navigate{}},
    {{"fit",           hold_control, yes,        true,  request}, Fit{}},
    {{"swing",         hold_control, yes,        true,  request}, Swing{}},
    {{"patch",         present,      by_content, true,  request}, Patch{}},
    {{"pick",          look,         by_content, true,  request}, Pick{}},
    {{"snapshot",      look,         no,         true,  request}, Snapshot{}},
    {{"fly",           hold_control, yes,        true,  request}, Fly{}},
    {{"cue",           hold_control, yes,        true,  request}, Cue{}},
    {{"check",         look,         no,         false, request}, Check{}},
    {{"tree",          look,         no,         true,  request}, Tree{}},
    {{"open",          hold_control, yes,        true,  request}, Open{}},
    {{"scenes",        look,         no,         true,  request}, Scenes{}},
    {{"record",        hold_control, yes,        true,  request}, Record{}},
    {{"control",       hold_control, no,         true,  request}, Control{}},
    {{"share",         hold_control, no,         false, request}, Share{}},
    {{"shown",         drive_walls,  no,         true,  request}, Shown{}},
    {{"point",         look,         no,         false, stream},  Point{}},
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
