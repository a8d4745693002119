#pragma once

#include <algorithm>

#include "fields.hpp"
#include "state.hpp"

/// Merge patches (RFC 7396) of what is described: null gives a member back the value that it starts with.
namespace vrut::protocol {

/// {"anyOf": [null, …]}.
Json nullable(Json schema);
/// Of a patch without a member yet.
Json patch_object_schema();

[[noreturn]] void refuse_read_only(const char* name, const std::string& path);
/// Throws BadJson where the patch has a member that is none of the known.
void refuse_unknown(const Json& patch, std::span<const std::string_view> known, const std::string& path);

/// Applies a patch's members to a struct.
template <class T>
class PatchReader {
public:
    PatchReader(const Json& patch, T& target, const T& start, const std::string& path)
        : patch_(patch), target_(target), start_(start), path_(path) {}

    template <class Member, class Kind>
    void writable(const char* name, Member T::*member, const Kind& kind, const char*) {
        const Json* found = look_up(name);
        if (!found) return;
        Member& target = target_.*member;
        const Member& start = start_.*member;
        if (found->is_null())
            target = start;
        else if constexpr (requires { kind.patch(target, start, *found, path_); })
            kind.patch(target, start, *found, path_of(path_, name));
        else
            assign(target, kind.read(*found, path_of(path_, name)));
    }
    template <class Member, class Kind>
    void fixed(const char* name, Member T::*, const Kind&, const char*) {
        if (look_up(name)) refuse_read_only(name, path_);
    }
    /// To be called at the end: every member of the patch must have been described.
    void finish() const { refuse_unknown(patch_, known_, path_); }

private:
    const Json* look_up(const char* name) {
        known_.push_back(name);
        return find_member(patch_, name);
    }

    const Json& patch_;
    T& target_;
    const T& start_;
    const std::string& path_;
    std::vector<std::string_view> known_;
};

template <class T>
void patch_struct(T& target, const T& start, const Json& patch, const std::string& path) {
    read_object(patch, path.empty() ? "patch" : path);
    PatchReader<T> reader(patch, target, start, path);
    describe(reader, static_cast<const T*>(nullptr));
    reader.finish();
}

/// Fills a struct from a document as write_struct() made it: what clients may change, over what is there. A
/// member that may be absent and is gets empty.
template <class T>
class DocumentReader {
public:
    DocumentReader(const Json& document, T& target, const std::string& path)
        : document_(document), target_(target), path_(path) {}

    template <class Member, class Kind>
    void writable(const char* name, Member T::*member, const Kind& kind, const char*) {
        Member& target = target_.*member;
        const Json* found = find_member(document_, name);
        const std::string path = path_of(path_, name);
        if constexpr (requires { kind.restore(target, *found, path); }) {
            if (found) kind.restore(target, *found, path);
        } else if constexpr (IsOptional<Member>::value) {
            target.reset();
            if (found) assign(target, kind.read(*found, path));
        } else if (found && *found != kind.write(target)) {
            // A value of the scene's own may lie beyond what clients may say.
            assign(target, kind.read(*found, path));
        }
    }
    template <class Member, class Kind>
    void fixed(const char*, Member T::*, const Kind&, const char*) {}

private:
    const Json& document_;
    T& target_;
    const std::string& path_;
};

template <class T>
void restore_struct(T& target, const Json& document, const std::string& path) {
    DocumentReader<T> reader(read_object(document, path.empty() ? "state" : path), target, path);
    describe(reader, static_cast<const T*>(nullptr));
}

/// The JSON Schema of a patch: nothing need be there, anything may be null, nothing else may be there.
template <class T>
class PatchSchemaWriter {
public:
    explicit PatchSchemaWriter(Json& schema) : schema_(schema) {}

    template <class Member, class Kind>
    void writable(const char* name, Member T::*, const Kind& kind, const char*) {
        if constexpr (requires { kind.patch_schema(); })
            put(schema_["properties"], name, nullable(kind.patch_schema()));
        else
            put(schema_["properties"], name, nullable(kind.schema()));
    }
    template <class Member, class Kind>
    void fixed(const char*, Member T::*, const Kind&, const char*) {}

private:
    Json& schema_;
};

template <class T>
Json patch_schema_of_struct() {
    Json schema = patch_object_schema();
    PatchSchemaWriter<T> writer(schema);
    describe(writer, static_cast<const T*>(nullptr));
    return schema;
}

// --- kinds that can be patched member by member

template <class T>
struct Section : Object<T> {
    void patch(T& target, const T& start, const Json& json, const std::string& path) const {
        patch_struct(target, start, json, path);
    }
    void restore(T& target, const Json& json, const std::string& path) const {
        restore_struct(target, json, path);
    }
    Json patch_schema() const { return patch_schema_of_struct<T>(); }
};

/// The scene's own: entries are neither added nor removed, and null gives one back its starting value.
template <class T>
struct Items : Table<T> {
    using Map = std::map<std::string, T>;
    void patch(Map& items, const Map& start, const Json& json, const std::string& path) const {
        for (const auto& [key, value] : read_object(json, path).items()) {
            const auto item = items.find(key);
            if (item == items.end())
                throw BadJson{error_code::unknown_node,
                              "there is no '" + excerpt(key) + "' in '" + path + "'"};
            if (value.is_null())
                item->second = start.at(key);
            else
                patch_struct(item->second, start.at(key), value, path + "." + key);
        }
    }
    void restore(Map& items, const Json& json, const std::string& path) const {
        read_object(json, path);
        for (auto& [key, item] : items)
            if (const auto found = json.find(key); found != json.end())
                restore_struct(item, *found, path + "." + key);
    }
    Json patch_schema() const { return table_schema(nullable(patch_schema_of_struct<T>())); }
};

/// The clients' own: a patch adds entries, and null removes one, or gives it back where it was there at the
/// start. `max_entries` 0: any number.
template <class T>
struct Entries : Table<T> {
    using Map = std::map<std::string, T>;
    std::size_t max_entries = 0;
    const char* required = nullptr;  ///< what a new one must have

    void patch(Map& entries, const Map& start, const Json& json, const std::string& path) const {
        for (const auto& [key, value] : read_object(json, path).items()) {
            check_key(key, path);
            const auto at_start = start.find(key);
            if (value.is_null()) {
                if (at_start != start.end())
                    entries[key] = at_start->second;
                else
                    entries.erase(key);
                continue;
            }
            const std::string entry_path = path + "." + excerpt(key);
            if (required && !entries.contains(key) &&
                read_object(value, entry_path).value(required, Json()).is_null())
                throw BadJson{error_code::bad_message,
                              "member '" + entry_path + "." + required + "' is missing"};
            patch_struct(entries[key], at_start != start.end() ? at_start->second : T{}, value, entry_path);
        }
        if (max_entries > 0 && entries.size() > max_entries)
            throw BadJson{error_code::too_many,
                          "'" + path + "' holds " + std::to_string(max_entries) + " entries at most"};
    }
    void restore(Map& entries, const Json& json, const std::string& path) const {
        entries.clear();
        for (const auto& [key, value] : read_object(json, path).items())
            restore_struct(entries[key], value, path + "." + excerpt(key));
    }
    Json patch_schema() const {
        return {{"type", "object"},
                {"propertyNames", {{"minLength", 1}, {"maxLength", kLongest}}},
                {"additionalProperties", nullable(patch_schema_of_struct<T>())}};
    }

private:
    static constexpr std::size_t kLongest = 100;
    static void check_key(const std::string& key, const std::string& path) {
        if (key.empty() || key.size() > kLongest)
            throw BadJson{error_code::out_of_range, "a name in '" + path + "' must have 1 to " +
                                                        std::to_string(kLongest) + " bytes, unlike '" +
                                                        excerpt(key) + "'"};
    }
};

/// A table whose entries are shared between states.
template <class Kind>
struct SharedTable {
    Kind kind;
    template <class T>
    void patch(SharedMap<T>& target, const SharedMap<T>& start, const Json& json,
               const std::string& path) const {
        auto map = *target;
        kind.patch(map, *start, json, path);
        target.set(std::move(map));
    }
    template <class T>
    void restore(SharedMap<T>& target, const Json& json, const std::string& path) const {
        auto map = *target;
        kind.restore(map, json, path);
        target.set(std::move(map));
    }
    template <class T>
    Json write(const SharedMap<T>& value) const {
        return kind.write(*value);
    }
    Json schema() const { return kind.schema(); }
    Json patch_schema() const { return kind.patch_schema(); }
};

/// A member of an entry that starts with what is shown: null removes what is in the member.
template <class Kind>
struct FromNothing : Kind {
    template <class T>
    void patch(T& target, const T&, const Json& json, const std::string& path) const {
        Kind::patch(target, T{}, json, path);
    }
};

}  // namespace vrut::protocol
