#include "fields.hpp"

#include <algorithm>

#include "state_fields.hpp"

namespace vrut::protocol {

std::string path_of(const std::string& path, const char* name) {
    return path.empty() ? name : path + "." + name;
}

const Json* find_member(const Json& object, const char* name) {
    const auto found = object.find(name);
    return found == object.end() ? nullptr : &*found;
}

const Json& require_member(const Json& object, const char* name, const std::string& path) {
    if (const Json* found = find_member(object, name)) return *found;
    throw BadJson{error_code::bad_message, "member '" + path_of(path, name) + "' is missing"};
}

void put(Json& object, const char* name, Json value) { object[name] = std::move(value); }

// --- schemas

Json number_schema(double min, double max) {
    return {{"type", "number"}, {"minimum", min}, {"maximum", max}};
}
Json integer_schema(std::int64_t min, std::int64_t max) {
    return {{"type", "integer"}, {"minimum", min}, {"maximum", max}};
}
Json type_schema(const char* type) { return {{"type", type}}; }
Json text_schema(std::size_t max) { return {{"type", "string"}, {"maxLength", max}}; }
Json word_schema(std::span<const std::string_view> words) { return {{"enum", words}}; }
Json list_schema(Json items, std::size_t min, std::size_t max) {
    return {{"type", "array"}, {"items", std::move(items)}, {"minItems", min}, {"maxItems", max}};
}
Json table_schema(Json entry) { return {{"type", "object"}, {"additionalProperties", std::move(entry)}}; }
Json reference_schema(const char* name) { return {{"$ref", std::string("#/$defs/") + name}}; }
Json object_schema() {
    return {{"type", "object"}, {"properties", Json::object()}, {"required", Json::array()}};
}

void add_property(Json& schema, const char* name, Json property, const char* meaning) {
    Json& added = schema["properties"][name] = std::move(property);
    added["description"] = meaning;
}
void add_required(Json& schema, const char* name) { schema["required"].push_back(name); }
void add_read_only(Json& schema, const char* name) { schema["properties"][name]["readOnly"] = true; }
void add_default(Json& schema, const char* name, Json value) {
    const bool says_nothing = value.is_string() ? value.get_ref<const std::string&>().empty() : value.empty();
    if (!says_nothing) schema["properties"][name]["default"] = std::move(value);
}

// --- patches

Json nullable(Json schema) { return {{"anyOf", {{{"type", "null"}}, std::move(schema)}}}; }

Json patch_object_schema() {
    return {{"type", "object"}, {"properties", Json::object()}, {"additionalProperties", false}};
}

void refuse_read_only(const char* name, const std::string& path) {
    throw BadJson{error_code::read_only, "'" + path_of(path, name) + "' is read-only"};
}

void refuse_unknown(const Json& patch, std::span<const std::string_view> known, const std::string& path) {
    for (const auto& [name, value] : patch.items())
        if (std::find(known.begin(), known.end(), name) == known.end())
            throw BadJson{error_code::unknown_member,
                          "the state has no member '" + path_of(path, excerpt(name).c_str()) + "'"};
}

}  // namespace vrut::protocol
