#include "fields.hpp"

#include <algorithm>

namespace vrut::protocol {

namespace {

/// The name of a member in an error: the path to its object, and its own name.
std::string path_of(const std::string& path, const char* name) {
    return path.empty() ? name : path + "." + name;
}

/// Null where the object has no such member.
const Json* find_member(const Json& object, const char* name) {
    const auto found = object.find(name);
    return found == object.end() ? nullptr : &*found;
}

void read_value(const Field& field, void* target, const Json& json, const std::string& path) {
    void* value = field.in(target);
    field.kind->read(json, path, field.type->hold ? field.type->hold(value) : value);
}

bool has_default(const FieldTable& table, const Field& field, const void* object) {
    const void* value = field.in(object);
    if (field.type->empty) return field.type->empty(value);
    return field.type->equal && field.type->equal(value, field.in(table.defaults));
}

}  // namespace

const void* Field::value_in(const void* object) const {
    return type->held ? type->held(in(object)) : in(object);
}

const FieldTable& made_table(const void* defaults, void (*describe)(FieldTable& table)) {
    auto* table = new FieldTable{defaults, {}};
    describe(*table);
    return *table;
}

void FieldList::add(const char* name, KindPtr kind, const Type* type, const void* member, const char* meaning,
                    Presence presence, unsigned rules) {
    const std::ptrdiff_t offset =
        static_cast<const std::byte*>(member) - static_cast<const std::byte*>(table_.defaults);
    table_.fields.push_back({name, meaning, kind, type, static_cast<std::size_t>(offset), presence, rules});
}

void FieldList::inline_fields(const FieldTable& part, const void* member) {
    for (const Field& field : part.fields)
        add(field.name, field.kind, field.type, field.in(member), field.meaning, field.presence, field.rules);
}

void read_fields(const FieldTable& table, void* target, const Json& object, const std::string& path) {
    for (const Field& field : table.fields) {
        const Json* found = find_member(object, field.name);
        if (found)
            read_value(field, target, *found, path_of(path, field.name));
        else if (field.presence == Presence::required)
            throw BadJson{error_code::bad_message, "member '" + path_of(path, field.name) + "' is missing"};
    }
}

Json write_fields(const FieldTable& table, const void* object) {
    Json json = Json::object();
    for (const Field& field : table.fields) {
        if (field.presence == Presence::optional && has_default(table, field, object)) continue;
        if (const void* value = field.value_in(object)) json[field.name] = field.kind->write(value);
    }
    return json;
}

void patch_fields(const FieldTable& table, void* target, const void* start, const Json& patch,
                  const std::string& path) {
    read_object(patch, path.empty() ? "patch" : path);
    for (const Field& field : table.fields) {
        const Json* found = find_member(patch, field.name);
        if (!found) continue;
        const std::string where = path_of(path, field.name);
        if (field.has(read_only)) throw BadJson{error_code::read_only, "'" + where + "' is read-only"};
        if (found->is_null())
            field.type->copy(field.in(target), field.in(start));
        else if (field.type->hold)
            read_value(field, target, *found, where);
        else
            field.kind->patch(field.in(target), field.in(field.has(from_nothing) ? table.defaults : start),
                              *found, where);
    }
    for (const auto& [name, value] : patch.items())
        if (std::ranges::find(table.fields, name, [](const Field& field) {
                return std::string_view(field.name);
            }) == table.fields.end())
            throw BadJson{error_code::unknown_member,
                          "the state has no member '" + path_of(path, excerpt(name).c_str()) + "'"};
}

void restore_fields(const FieldTable& table, void* target, const Json& document, const std::string& path) {
    read_object(document, path.empty() ? "state" : path);
    for (const Field& field : table.fields) {
        if (field.has(read_only)) continue;
        const Json* found = find_member(document, field.name);
        const std::string where = path_of(path, field.name);
        if (field.type->reset) field.type->reset(field.in(target));
        if (found && field.type->hold)
            read_value(field, target, *found, where);
        else if (found)
            field.kind->restore(field.in(target), *found, where);
    }
}

void copy_fields(const FieldTable& table, Rules rule, void* to, const void* from) {
    for (const Field& field : table.fields)
        if (field.has(rule))
            field.type->copy(field.in(to), field.in(from));
        else if (const FieldTable* within = field.type->held ? nullptr : field.kind->members())
            copy_fields(*within, rule, field.in(to), field.in(from));
}

void copy_common_fields(Rules rule, const FieldTable& to_table, void* to, const FieldTable& from_table,
                        const void* from) {
    for (const Field& target : to_table.fields)
        for (const Field& source : from_table.fields) {
            if (std::string_view(target.name) != source.name) continue;
            const FieldTable *within = target.kind->members(), *others = source.kind->members();
            if (target.type == source.type && (target.has(rule) || source.has(rule)))
                target.type->copy(target.in(to), source.in(from));
            else if (within && others && !target.type->held && !source.type->held)
                copy_common_fields(rule, *within, target.in(to), *others, source.in(from));
        }
}

Json merge_diff(const Json& from, const Json& to) {
    Json diff = Json::object();
    for (const auto& [name, value] : to.items()) {
        const auto old = from.find(name);
        if (old == from.end())
            diff[name] = value;
        else if (*old == value)
            continue;
        else
            diff[name] = old->is_object() && value.is_object() ? merge_diff(*old, value) : value;
    }
    for (const auto& [name, value] : from.items())
        if (!to.contains(name)) diff[name] = nullptr;
    return diff;
}

// --- schemas

Json schema_of(const FieldTable& table) {
    Json schema = {{"type", "object"}, {"properties", Json::object()}, {"required", Json::array()}};
    for (const Field& field : table.fields) {
        Json& property = schema["properties"][field.name] = field.kind->schema();
        property["description"] = field.meaning;
        if (field.has(read_only)) property["readOnly"] = true;
        if (field.type->held) continue;
        if (field.presence != Presence::optional) {
            schema["required"].push_back(field.name);
        } else if (Json value = field.kind->write(field.in(table.defaults));
                   value.is_string() ? !value.get_ref<const std::string&>().empty() : !value.empty()) {
            property["default"] = std::move(value);
        }
    }
    return schema;
}

Json patch_schema_of(const FieldTable& table) {
    Json schema = {{"type", "object"}, {"properties", Json::object()}, {"additionalProperties", false}};
    for (const Field& field : table.fields)
        if (!field.has(read_only)) schema["properties"][field.name] = nullable(field.kind->patch_schema());
    return schema;
}

}  // namespace vrut::protocol
