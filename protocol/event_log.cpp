#include "event_log.hpp"

#include <cmath>

#include "client_codec.hpp"
#include "codec.hpp"
#include "event_log_descriptions.hpp"

namespace vrut::protocol {

namespace {

class LoggedClientKind : public Kind {
public:
    void read(const Json& json, const std::string& path, void* value) const override {
        object_->read(json, path, value);
        if (json.contains("width"))
            static_cast<LogHeader::Client*>(value)->wanted = read_struct<Resize>(json, path);
    }
    Json write(const void* value) const override {
        Json json = object_->write(value);
        const auto& wanted = static_cast<const LogHeader::Client*>(value)->wanted;
        if (wanted) json.update(write_struct(*wanted));
        return json;
    }
    Json schema() const override {
        Json schema = object_->schema();
        schema["properties"].update(schema_of_struct<Resize>()["properties"]);
        return schema;
    }

private:
    KindPtr object_ = bind(Object{}, Of<LogHeader::Client>{});
};

class ObjectTextKind : public Kind {
public:
    void read(const Json& json, const std::string& path, void* value) const override {
        *static_cast<std::string*>(value) = dump(read_object(json, path));
    }
    Json write(const void* value) const override {
        const auto& text = *static_cast<const std::string*>(value);
        return text.empty() ? Json::object() : Json::parse(text);
    }
    Json schema() const override { return {{"$ref", "#/$defs/statePatch"}}; }
};

// The state document of a large scene is large.
constexpr int kMaxLogDepth = kMaxDepth + 2;

LogTime read_time(const Json& json) {
    const double ms = read_number(json, "at", kLogTime.min, kLogTime.max);
    return LogTime(std::llround(ms * 1000));
}

double to_ms(LogTime time) { return static_cast<double>(time.count()) / 1000; }

const Json& member(const Json& json, const char* name) {
    if (!json.contains(name))
        throw BadJson{error_code::bad_message, "member '" + std::string(name) + "' is missing"};
    return json[name];
}

ClientMessage read_client_message(const Json& json) {
    ClientMessage message;
    if (const auto id = read_object(json, "message").find("id"); id != json.end())
        message.id = read_integer(*id, "id", 1, kMaxInteger);
    message.payload = read_payload(json);
    return message;
}

/// A line that is no message.
void read_event(const Json& json, LogLine& line) {
    const std::string event = read_string(member(json, "event"), "event", 100);
    bool found = false;
    for_each_event([&](const char* name, const char*, auto prototype) {
        if (event != name) return;
        found = true;
        line.what = read_struct<decltype(prototype)>(json, "");
    });
    if (!found)
        throw BadJson{error_code::out_of_range, "'event': there is no event '" + excerpt(event) + "'"};
}

/// With members that nobody knows, too, but nothing secret.
Json as_it_came(const ClientMessage& message) {
    if (message.text.empty()) return to_json(message);
    Json json = parse_strictly(message.text);
    json.erase("token");
    if (message.id)
        json["id"] = *message.id;  // merged messages have the first one's, where the last has none
    return json;
}

void write_event(const decltype(LogLine::what)& what, Json& json) {
    for_each_event([&](const char* name, const char*, const auto& prototype) {
        const auto* event = std::get_if<std::decay_t<decltype(prototype)>>(&what);
        if (!event) return;
        json.update(write_struct(*event));
        json["event"] = name;
    });
}

}  // namespace

KindPtr bind(const LoggedClient&, Of<LogHeader::Client>) { return made<LoggedClientKind>(); }
KindPtr bind(const ObjectText&, Of<std::string>) { return made<ObjectTextKind>(); }

std::string encode(const LogHeader& header) {
    const Json json = write_struct(header);
    // What it is stands first, for whoever looks at the file.
    return R"({"log":")" + std::string(kLog) + R"(","version":)" + std::to_string(kVersion) + "," +
           dump(json).substr(1);
}

std::string encode(const LogLine& line) {
    Json json = {{"at", to_ms(line.at)}};
    if (!line.client.empty()) json["client"] = line.client;
    if (line.sequence > 0) json["sequence"] = line.sequence;
    if (const auto* message = std::get_if<ClientMessage>(&line.what))
        json["message"] = as_it_came(*message);
    else
        write_event(line.what, json);
    return dump(json);
}

tl::expected<LogHeader, Error> decode_log_header(std::string_view text) {
    return or_error([&] {
        const Json json = parse_strictly(text, kMaxLogDepth);
        if (read_string(member(read_object(json, "header"), "log"), "log", 100) != kLog)
            throw BadJson{error_code::bad_message, "'log' must be \"" + std::string(kLog) + "\""};
        read_integer(member(json, "version"), "version", kVersion, kVersion);
        LogHeader header = read_struct<LogHeader>(json, "");
        if (header.flight) check(header.flight->fly);
        return header;
    });
}

tl::expected<LogLine, Error> decode_log_line(std::string_view text) {
    return or_error([&] {
        const Json json = parse_strictly(text, kMaxLogDepth);
        LogLine line;
        line.at = read_time(member(read_object(json, "line"), "at"));
        if (json.contains("client")) line.client = read_string(json["client"], "client", kClientId.max);
        if (json.contains("sequence"))
            line.sequence =
                static_cast<std::uint64_t>(read_integer(json["sequence"], "sequence", 1, kMaxInteger));
        if (json.contains("message"))
            line.what = read_client_message(json["message"]);
        else
            read_event(json, line);
        const bool of_nobody = std::holds_alternative<LogLine::ControlPassed>(line.what) ||
                               std::holds_alternative<LogLine::Opened>(line.what) ||
                               std::holds_alternative<LogLine::Drawn>(line.what) ||
                               std::holds_alternative<LogLine::Revised>(line.what);
        if (line.client.empty() && !of_nobody)
            throw BadJson{error_code::bad_message, "member 'client' is missing"};
        return line;
    });
}

}  // namespace vrut::protocol
