#include "codec.hpp"

#include <algorithm>

#include "client_codec.hpp"
#include "client_descriptions.hpp"
#include "message_table.hpp"
#include "server_descriptions.hpp"

namespace vrut::protocol {

void check(const Fly& fly) {
    for (std::size_t i = 1; i < fly.keyframes.size(); ++i)
        if (!(fly.keyframes[i].at > fly.keyframes[i - 1].at))
            throw BadJson{error_code::out_of_range,
                          "'keyframes[" + std::to_string(i) + "].at' must be later than the one before"};
}

namespace {

void check(const Record& record) {
    for (const char c : record.name)
        if (!((c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' ||
              c == '-'))
            throw BadJson{error_code::out_of_range, "'name' must hold letters, digits, '_' and '-' only"};
}

void check(const Control& control) {
    using Action = Control::Action;
    if ((control.action == Action::give || control.action == Action::decline) && !control.client)
        throw BadJson{error_code::bad_message, "member 'client' is missing"};
}

/// Both coordinates come, or neither.
void check(const Point& point) {
    if (point.x && !point.y) throw BadJson{error_code::bad_message, "member 'y' is missing"};
    if (!point.x && (point.y || point.frame)) throw BadJson{error_code::bad_message, "member 'x' is missing"};
}

/// What of a message is wrong although each member by itself is right.
void check(const decltype(ClientMessage::payload)& payload) {
    if (const auto* record = std::get_if<Record>(&payload)) check(*record);
    if (const auto* control = std::get_if<Control>(&payload)) check(*control);
    if (const auto* point = std::get_if<Point>(&payload)) check(*point);
    if (const auto* fly = std::get_if<Fly>(&payload)) check(*fly);
}

template <class... Messages>
std::vector<ServerMessageType> types_of(const std::variant<Messages...>*) {
    return {{Messages::kType, table_of<Messages>()}...};
}

}  // namespace

decltype(ClientMessage::payload) read_payload(const Json& json) {
    if (!json.contains("type")) throw BadJson{error_code::bad_message, "member 'type' is missing"};
    const std::string name = read_string(json["type"], "type", kMaxMessageBytes);
    const auto types = client_message_types();
    const auto type = std::ranges::find_if(types, [&](const auto& each) { return name == each.traits.type; });
    if (type == types.end())
        throw BadJson{error_code::bad_message, "there is no message type '" + excerpt(name) + "'"};
    decltype(ClientMessage::payload) payload = type->prototype;
    std::visit([&](auto& message) { read_fields(table_of_value(message), &message, json, ""); }, payload);
    check(payload);
    return payload;
}

const FieldTable& table_of_message(const decltype(ClientMessage::payload)& payload) {
    return std::visit([](const auto& message) -> const FieldTable& { return table_of_value(message); },
                      payload);
}

Json to_json(const ClientMessage& message) {
    Json json = std::visit([](const auto& payload) { return write_struct(payload); }, message.payload);
    json["type"] = traits_of(message).type;
    if (message.id) json["id"] = *message.id;
    return json;
}

tl::expected<ClientMessage, Error> decode(std::string_view text) {
    ClientMessage message;
    try {
        if (text.size() > kMaxMessageBytes)
            throw BadJson{error_code::bad_message,
                          "the message is longer than " + std::to_string(kMaxMessageBytes) + " bytes"};
        const Json json = parse_strictly(text);
        if (!json.is_object()) throw BadJson{error_code::bad_message, "the message must be a JSON object"};
        if (const auto id = json.find("id"); id != json.end())
            message.id = read_integer(*id, "id", 1, kMaxInteger);
        message.payload = read_payload(json);
        message.text = text;
        return message;
    } catch (const BadJson& bad) {
        return tl::unexpected(Error{message.id, bad.code, bad.message});
    }
}

tl::expected<Fly, Error> parse_flight(std::string_view text) {
    return or_error([&] {
        const Json json = parse_strictly(text);
        if (!json.is_object()) throw BadJson{error_code::bad_message, "a flight must be a JSON object"};
        auto fly = read_struct<Fly>(json, "");
        check(fly);
        return fly;
    });
}

std::string encode(const ClientMessage& message) { return dump(to_json(message)); }

const char* name_of(Role role) { return kRole.words[static_cast<std::size_t>(role)].data(); }
const char* name_of(NavigationState::Style style) {
    return kStyle.words[static_cast<std::size_t>(style)].data();
}

std::span<const ServerMessageType> server_message_types() {
    static const auto types = types_of(static_cast<const ServerMessage*>(nullptr));
    return types;
}

std::string encode_server_message(std::size_t place, const void* message) {
    const ServerMessageType& type = server_message_types()[place];
    Json json = write_fields(type.table, message);
    json["type"] = type.name;
    return dump(json);
}

}  // namespace vrut::protocol
