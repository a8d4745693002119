#include "room_relay.hpp"

#include <algorithm>

#include "descriptions.hpp"

namespace vrut::protocol {

namespace {

constexpr std::size_t kMostText = std::size_t{256} << 20;  // of documents
constexpr std::size_t kMostOfOne = 100'000;                // clients of an edge
constexpr Text kAnyText{kMostText};
constexpr Integer kCount{};

}  // namespace

template <class V>
void describe(V& v, const EdgeClient*) {
    v.required("client", &EdgeClient::client, kName, "Its name in the state.");
    v.required("role", &EdgeClient::role, kRole, "Asked for.");
    v.optional("token", &EdgeClient::token, Text{1000}, "As it gave it.");
    v.optional("name", &EdgeClient::name, Text{kMaxClientName}, "As it calls itself.");
    v.optional("resume", &EdgeClient::resume, Text{1000}, "As it gave it.");
    v.optional("id", &EdgeClient::id, kCount, "Of its hello.");
    v.optional("handled", &EdgeClient::handled, kCount, "The last message whose handling is known.");
}
template <class V>
void describe(V& v, const EdgeSync*) {
    v.required("version", &EdgeSync::version, kCount, "Of these messages.");
    v.required("clients", &EdgeSync::clients, List<Object<EdgeClient>>{{}, 0, kMostOfOne},
               "All of the edge.");
}
template <class V>
void describe(V&, const EdgeAlive*) {}
template <class V>
void describe(V& v, const EdgeAdmission*) {
    v.required("number", &EdgeAdmission::number, kCount, "Comes back with the answer.");
    v.required("role", &EdgeAdmission::role, kRole, "Asked for.");
    v.optional("token", &EdgeAdmission::token, Text{1000}, "As the client gave it.");
}
template <class V>
void describe(V& v, const EdgeJoined*) {
    v.required("joined", &EdgeJoined::client, Object<EdgeClient>{}, "Who came.");
}
template <class V>
void describe(V& v, const EdgeLeft*) {
    v.required("client", &EdgeLeft::client, kName, "Who left.");
}
template <class V>
void describe(V& v, const EdgeSaid*) {
    v.required("client", &EdgeSaid::client, kName, "Who said it.");
    v.required("sequence", &EdgeSaid::sequence, kCount, "Of this client's messages.");
    v.required("text", &EdgeSaid::text, Text{kMaxMessageBytes}, "The message.");
    v.optional("again", &EdgeSaid::again, Flag{}, "It was sent before.");
}
template <class V>
void describe(V& v, const EdgeWanted*) {
    v.required("client", &EdgeWanted::client, kName, "Who wants frames.");
    v.required("newerThan", &EdgeWanted::newer_than, kCount, "Number of a frame.");
    v.required("count", &EdgeWanted::count, Integer{0, 1000}, "At most so many.");
    v.required("since", &EdgeWanted::since_sequence, kCount,
               "They show what its messages up to this one did.");
    v.optional("bytesPerSecond", &EdgeWanted::bytes_per_second, Number{1e-3, kFastestLink}, "Of its link.");
    v.optional("roundTripMs", &EdgeWanted::round_trip_ms, Number{0, 1e9}, "Of its link.");
}
template <class V>
void describe(V& v, const EdgeSnapshotSent*) {
    v.required("client", &EdgeSnapshotSent::client, kName, "Who got it.");
}
template <class V>
void describe(V& v, const EdgePicture*) {
    v.required("name", &EdgePicture::name, kName, "By which it is known.");
    v.required("width", &EdgePicture::width, Integer{0, 1 << 20}, "Pixels.");
    v.required("height", &EdgePicture::height, Integer{0, 1 << 20}, "Pixels.");
}

template <class V>
void describe(V& v, const RoomAnswer*) {
    v.required("client", &RoomAnswer::client, kName, "For whom it is.");
    v.required("text", &RoomAnswer::text, kAnyText, "The message.");
    v.required("revision", &RoomAnswer::revision, kCount, "Of the state that it must know.");
}
template <class V>
void describe(V& v, const RoomHandled*) {
    v.required("client", &RoomHandled::client, kName, "Whose messages were handled.");
    v.required("sequence", &RoomHandled::sequence, kCount, "Of the last.");
}
template <class V>
void describe(V& v, const RoomOutput*) {
    v.optional("edge", &RoomOutput::edge, kName, "All that this one has to know.");
    v.optional("state", &RoomOutput::state, kAnyText, "A `state` or a `patch`.");
    v.optional("from", &RoomOutput::from, kCount, "The revision before a `patch`.");
    v.optional("by", &RoomOutput::by, kAnyText, "Who made it.");
    v.optional("bySince", &RoomOutput::by_since, kCount, "The first revision made by the same.");
    v.optional("answers", &RoomOutput::answers, List<Object<RoomAnswer>>{{}, 0, kMostOfOne},
               "In this order.");
    v.optional("again", &RoomOutput::again, Flag{}, "Some of the answers may have come before.");
    v.optional("failed", &RoomOutput::failed_pictures, List<Text>{kName, 0, kMostOfOne},
               "Images that cannot be drawn.");
    v.optional("handled", &RoomOutput::handled, List<Object<RoomHandled>>{{}, 0, kMostOfOne}, "Messages.");
    v.optional("width", &RoomOutput::width, Integer{0, 1 << 20}, "Of a picture of the view.");
    v.optional("height", &RoomOutput::height, Integer{0, 1 << 20}, "Of a picture of the view.");
    v.optional("present", &RoomOutput::present_frame, kCount, "The frame that shows what is to be seen.");
    v.optional("stats", &RoomOutput::stats, kAnyText, "A message for all.");
    v.optional("loading", &RoomOutput::loading, kAnyText, "A message for all.");
    v.optional("loads", &RoomOutput::loads, Flag{}, "Loading goes on.");
}
template <class V>
void describe(V& v, const RoomAlive*) {
    v.required("version", &RoomAlive::version, kCount, "Of these messages.");
    v.required("edges", &RoomAlive::edges, List<Text>{kName, 0, kMostOfOne}, "That are known.");
    v.required("renderer", &RoomAlive::renderer, kAnyText, "What draws.");
    v.required("maxPixels", &RoomAlive::max_pixels, kCount, "Of a picture.");
    v.required("maxSide", &RoomAlive::max_side, Integer{0, 1 << 20}, "Of a picture.");
    v.optional("unready", &RoomAlive::unready, kAnyText, "Why it cannot draw.");
}
template <class V>
void describe(V& v, const RoomAdmitted*) {
    v.required("edge", &RoomAdmitted::edge, kName, "That has asked.");
    v.required("question", &RoomAdmitted::question, kCount, "Of the question.");
    v.optional("role", &RoomAdmitted::role, kRole, "That the client gets.");
    v.optional("why", &RoomAdmitted::why, kAnyText, "It may not come in.");
}
template <class V>
void describe(V& v, const RoomApplied*) {
    v.required("client", &RoomApplied::client, kName, "Whose messages it shows.");
    v.required("id", &RoomApplied::id, kCount, "The highest.");
    v.required("sequence", &RoomApplied::sequence, kCount, "The last.");
}
template <class V>
void describe(V& v, const RoomPicture*) {
    v.required("frame", &RoomPicture::frame, kCount, "Its number.");
    v.required("revision", &RoomPicture::revision, kCount, "Of the state.");
    v.optional("handled", &RoomPicture::handled, kCount, "The highest message that it shows.");
    v.optional("snapshot", &RoomPicture::snapshot, kCount, "The message that asked for it.");
    v.optional("client", &RoomPicture::client, kName, "Who asked for it.");
    v.required("format", &RoomPicture::format, kFormat, "Of the bytes.");
    v.required("header", &RoomPicture::header, kAnyText, "What it says about itself.");
    v.required("headerOffset", &RoomPicture::header_offset, kCount, "Where in the bytes the header goes.");
    v.optional("applied", &RoomPicture::applied, List<Object<RoomApplied>>{{}, 0, kMostOfOne}, "By client.");
    v.optional("newestInputMs", &RoomPicture::newest_input_ms, Number{-1e15, 1e15}, "Arrival.");
    v.required("idleSinceMs", &RoomPicture::idle_since_ms, Number{-1e15, 1e15}, "The newest change.");
    v.required("sentMs", &RoomPicture::sent_ms, Number{-1e15, 1e15}, "Now.");
}
template <class V>
void describe(V&, const RoomLeft*) {}

namespace {

/// Reads what lies in a variant by the member "type": the names in the order of its alternatives.
template <class Variant, std::size_t N>
class Alternatives {
public:
    explicit constexpr Alternatives(std::array<std::string_view, N> names) : names_(names) {}

    Json write(const Variant& what) const {
        Json json = std::visit([](const auto& each) { return write_struct(each); }, what);
        json["type"] = names_[what.index()];
        return json;
    }
    Variant read(const Json& json) const {
        if (!json.contains("type")) throw BadJson{error_code::bad_message, "member 'type' is missing"};
        return read_at<0>(json, read_word(json["type"], "type", names_));
    }

private:
    template <std::size_t I>
    Variant read_at(const Json& json, std::size_t index) const {
        if constexpr (I + 1 < std::variant_size_v<Variant>)
            if (index != I) return read_at<I + 1>(json, index);
        return read_struct<std::variant_alternative_t<I, Variant>>(json, "");
    }
    std::array<std::string_view, N> names_;
};

constexpr Alternatives<decltype(EdgeMessage::what), 9> kFromEdge({"sync", "alive", "admission", "joined",
                                                                  "left", "said", "wanted", "snapshotSent",
                                                                  "picture"});
constexpr Alternatives<decltype(RoomMessage::what), 5> kFromRoom({"output", "alive", "admitted", "picture",
                                                                  "left"});

template <class Read>
auto parsed(std::string_view text, Read read) {
    return or_error([&] {
               const Json json = parse_strictly(text);
               if (!json.is_object())
                   throw BadJson{error_code::bad_message, "the message must be a JSON object"};
               return read(json);
           })
        .map_error([](const Error& error) { return error.message; });
}

}  // namespace

bool is_room_name(std::string_view name) {
    return !name.empty() && name.size() <= 32 && std::all_of(name.begin(), name.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
    });
}

std::string answer_key(std::string_view text) {
    const Json answer = Json::parse(text, nullptr, false);
    if (!answer.is_object() || !answer.contains("id")) return {};
    return dump(answer["id"]) + " " + dump(answer.value("type", Json()));
}

std::string encode(const EdgeMessage& message) {
    Json json = kFromEdge.write(message.what);
    json["edge"] = message.edge;
    return dump(json);
}

std::string encode(const RoomMessage& message) {
    Json json = kFromRoom.write(message.what);
    json["lease"] = message.lease;
    json["number"] = message.number;
    return dump(json);
}

tl::expected<EdgeMessage, std::string> parse_edge_message(std::string_view text) {
    return parsed(text, [](const Json& json) {
        if (!json.contains("edge")) throw BadJson{error_code::bad_message, "member 'edge' is missing"};
        return EdgeMessage{read_string(json["edge"], "edge", 100), kFromEdge.read(json)};
    });
}

tl::expected<RoomMessage, std::string> parse_room_message(std::string_view text) {
    return parsed(text, [](const Json& json) {
        const auto number = [&](const char* name) {
            if (!json.contains(name))
                throw BadJson{error_code::bad_message, "member '" + std::string(name) + "' is missing"};
            return static_cast<std::uint64_t>(read_integer(json[name], name, 0, kMaxInteger));
        };
        return RoomMessage{number("lease"), number("number"), kFromRoom.read(json)};
    });
}

}  // namespace vrut::protocol
