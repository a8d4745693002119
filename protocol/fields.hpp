#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "json_reader.hpp"

/// The members of what travels, each described once: `describe(visitor, const T*)` names a struct's members
/// with the kind and the meaning of each. Readers, writers and the JSON Schema are visitors; the schema's
/// tables in the pages beside this file follow from it. For protocol's own .cpp files.
namespace vrut::protocol {

template <class T>
struct IsOptional : std::false_type {};
template <class T>
struct IsOptional<std::optional<T>> : std::true_type {};
template <class T>
struct IsListOfWords : std::false_type {};
template <class T>
struct IsListOfWords<std::vector<T>> : std::is_enum<T> {};

/// What a kind has read, as the member's own type.
template <class Member, class Value>
void assign(Member& member, Value&& value) {
    if constexpr (IsOptional<Member>::value)
        member = static_cast<typename Member::value_type>(std::forward<Value>(value));
    else if constexpr (IsListOfWords<Member>::value) {
        member.clear();
        for (const std::size_t word : value) member.push_back(static_cast<typename Member::value_type>(word));
    } else
        member = static_cast<Member>(std::forward<Value>(value));
}

// What visitors do whatever the member's type, so that it is compiled once.

/// The name of a member in an error: the path to its object, and its own name.
std::string path_of(const std::string& path, const char* name);
/// Null where the object has no such member.
const Json* find_member(const Json& object, const char* name);
/// Throws BadJson where the object, to which `path` leads, has no such member.
const Json& require_member(const Json& object, const char* name, const std::string& path);
void put(Json& object, const char* name, Json value);

Json number_schema(double min, double max);
Json integer_schema(std::int64_t min, std::int64_t max);
Json type_schema(const char* type);
Json text_schema(std::size_t max);
Json word_schema(std::span<const std::string_view> words);
Json list_schema(Json items, std::size_t min, std::size_t max);
Json table_schema(Json entry);
Json reference_schema(const char* name);
Json object_schema();
void add_property(Json& schema, const char* name, Json property, const char* meaning);
void add_required(Json& schema, const char* name);
void add_read_only(Json& schema, const char* name);
/// Left out where it is empty.
void add_default(Json& schema, const char* name, Json value);

/// A value of which each member has its default.
template <class T>
const T& defaults_of() {
    static const T defaults{};
    return defaults;
}

template <class T>
T read_struct(const Json& json, const std::string& path);
template <class T>
Json write_struct(const T& value);
template <class T>
Json schema_of_struct();

// --- kinds: what a value may be. Each reads itself (and throws BadJson), writes itself, and has a schema.

struct Number {
    double min, max;
    double read(const Json& json, const std::string& path) const { return read_number(json, path, min, max); }
    Json write(double value) const { return value; }
    Json schema() const { return number_schema(min, max); }
};

struct Integer {
    std::int64_t min = 0, max = kMaxInteger;
    std::int64_t read(const Json& json, const std::string& path) const {
        return read_integer(json, path, min, max);
    }
    template <class T>
    Json write(T value) const {
        return value;
    }
    Json schema() const { return integer_schema(min, max); }
};

struct Flag {
    bool read(const Json& json, const std::string& path) const { return read_bool(json, path); }
    Json write(bool value) const { return value; }
    Json schema() const { return type_schema("boolean"); }
};

/// At most `max` bytes of UTF-8.
struct Text {
    std::size_t max;
    std::string read(const Json& json, const std::string& path) const { return read_string(json, path, max); }
    Json write(const std::string& value) const { return value; }
    Json schema() const { return text_schema(max); }
};

/// An enumerator by its name: words[0] is that of value 0.
template <std::size_t N>
struct Word {
    std::array<std::string_view, N> words;
    std::size_t read(const Json& json, const std::string& path) const { return read_word(json, path, words); }
    template <class Enum>
    Json write(Enum value) const {
        return words[static_cast<std::size_t>(value)];
    }
    Json schema() const { return word_schema(words); }
};
template <class... Words>
constexpr Word<sizeof...(Words)> word(Words... words) {
    return {{words...}};
}

template <class V>
struct Vector {
    double min, max;
    V read(const Json& json, const std::string& path) const { return read_vector<V>(json, path, min, max); }
    Json write(const V& value) const { return to_json(value); }
    Json schema() const { return list_schema(Number{min, max}.schema(), V::length(), V::length()); }
};

/// 16 numbers row by row.
struct Matrix {
    double max;  ///< of each number's size
    glm::dmat4 read(const Json& json, const std::string& path) const { return read_matrix(json, path, max); }
    Json write(const glm::dmat4& value) const { return to_json(value); }
    Json schema() const { return list_schema(Number{-max, max}.schema(), 16, 16); }
};

template <class Element>
struct List {
    Element element;
    std::size_t min, max;
    auto read(const Json& json, const std::string& path) const {
        read_array(json, path, min, max);
        std::vector<decltype(element.read(json, path))> values;
        for (std::size_t i = 0; i < json.size(); ++i)
            values.push_back(element.read(json[i], path + "[" + std::to_string(i) + "]"));
        return values;
    }
    template <class T>
    Json write(const std::vector<T>& values) const {
        Json json = Json::array();
        for (const T& value : values) json.push_back(element.write(value));
        return json;
    }
    Json schema() const { return list_schema(element.schema(), min, max); }
};

template <class T>
struct Object {
    T read(const Json& json, const std::string& path) const { return read_struct<T>(json, path); }
    Json write(const T& value) const { return write_struct(value); }
    Json schema() const { return schema_of_struct<T>(); }
};

/// What several places of the schema refer to by `name`.
template <class Kind>
struct Defined : Kind {
    const char* name;
    Json schema() const { return reference_schema(name); }
};

/// {"ID or NAME": {…}}, to be written only.
template <class T>
struct Table {
    Json write(const std::map<std::string, T>& values) const {
        Json json = Json::object();
        for (const auto& [key, value] : values) json[key] = write_struct(value);
        return json;
    }
    Json schema() const { return table_schema(schema_of_struct<T>()); }
};

/// {"NAME": value}, to be written only.
template <class Kind>
struct ValuesByName {
    Kind kind;
    template <class T>
    Json write(const std::map<std::string, T>& values) const {
        Json json = Json::object();
        for (const auto& [name, value] : values) json[name] = kind.write(value);
        return json;
    }
    Json schema() const { return table_schema(kind.schema()); }
};

/// What is shared because it is large and seldom changes.
template <class Kind>
struct SharedKind {
    Kind kind;
    template <class T>
    Json write(const T& shared) const {
        return kind.write(*shared.value);
    }
    Json schema() const { return kind.schema(); }
};

/// Any object, kept as it is.
struct AnyObject {
    Json schema_value;
    std::shared_ptr<const Json> read(const Json& json, const std::string& path) const {
        return std::make_shared<const Json>(read_object(json, path));
    }
    Json write(const std::shared_ptr<const Json>& value) const { return *value; }
    Json schema() const { return schema_value; }
};

// --- visitors

/// Fills a struct from an object; what is not described is ignored.
template <class T>
class Reader {
public:
    Reader(const Json& object, T& target, const std::string& path)
        : object_(object), target_(target), path_(path) {}

    template <class Member, class Kind>
    void required(const char* name, Member T::*member, const Kind& kind, const char*) {
        read(name, member, kind, &require_member(object_, name, path_));
    }
    template <class Member, class Kind>
    void optional(const char* name, Member T::*member, const Kind& kind, const char*) {
        read(name, member, kind, find_member(object_, name));
    }
    /// Members that stand in the same object.
    template <class Member>
    void inlined(Member T::*member) {
        Reader<Member> part(object_, target_.*member, path_);
        describe(part, static_cast<const Member*>(nullptr));
    }
    // A whole section of the state: what clients may not change is read, too.
    template <class Member, class Kind>
    void writable(const char* name, Member T::*member, const Kind& kind, const char* meaning) {
        optional(name, member, kind, meaning);
    }
    template <class Member, class Kind>
    void fixed(const char* name, Member T::*member, const Kind& kind, const char* meaning) {
        optional(name, member, kind, meaning);
    }

private:
    template <class Member, class Kind>
    void read(const char* name, Member T::*member, const Kind& kind, const Json* found) {
        if (found) assign(target_.*member, kind.read(*found, path_of(path_, name)));
    }

    const Json& object_;
    T& target_;
    const std::string& path_;
};

template <class T>
class Writer {
public:
    Writer(const T& value, Json& object) : value_(value), object_(object) {}

    template <class Member, class Kind>
    void required(const char* name, Member T::*member, const Kind& kind, const char*) {
        if constexpr (!IsOptional<Member>::value)
            put(object_, name, kind.write(value_.*member));
        else if (value_.*member)
            put(object_, name, kind.write(*(value_.*member)));
    }
    /// What has its default is left out.
    template <class Member, class Kind>
    void optional(const char* name, Member T::*member, const Kind& kind, const char* meaning) {
        if constexpr (requires { (value_.*member).empty(); }) {
            if ((value_.*member).empty()) return;
        } else if constexpr (requires { value_.*member == value_.*member; }) {
            if (value_.*member == defaults_of<T>().*member) return;
        }
        required(name, member, kind, meaning);
    }
    template <class Member>
    void inlined(Member T::*member) {
        Writer<Member> part(value_.*member, object_);
        describe(part, static_cast<const Member*>(nullptr));
    }
    template <class Member, class Kind>
    void writable(const char* name, Member T::*member, const Kind& kind, const char* meaning) {
        required(name, member, kind, meaning);
    }
    template <class Member, class Kind>
    void fixed(const char* name, Member T::*member, const Kind& kind, const char* meaning) {
        required(name, member, kind, meaning);
    }

private:
    const T& value_;
    Json& object_;
};

/// The JSON Schema of an object.
template <class T>
class SchemaWriter {
public:
    explicit SchemaWriter(Json& schema) : schema_(schema) {}

    template <class Member, class Kind>
    void required(const char* name, Member T::*, const Kind& kind, const char* meaning) {
        add_property(schema_, name, kind.schema(), meaning);
        if (!IsOptional<Member>::value) add_required(schema_, name);
    }
    template <class Member, class Kind>
    void optional(const char* name, Member T::*member, const Kind& kind, const char* meaning) {
        add_property(schema_, name, kind.schema(), meaning);
        if constexpr (!IsOptional<Member>::value)
            add_default(schema_, name, kind.write(defaults_of<T>().*member));
    }
    template <class Member>
    void inlined(Member T::*) {
        SchemaWriter<Member> part(schema_);
        describe(part, static_cast<const Member*>(nullptr));
    }
    template <class Member, class Kind>
    void writable(const char* name, Member T::*member, const Kind& kind, const char* meaning) {
        required(name, member, kind, meaning);
    }
    template <class Member, class Kind>
    void fixed(const char* name, Member T::*member, const Kind& kind, const char* meaning) {
        required(name, member, kind, meaning);
        add_read_only(schema_, name);
    }

private:
    Json& schema_;
};

template <class T>
T read_struct(const Json& json, const std::string& path) {
    read_object(json, path.empty() ? "message" : path);
    T value{};
    Reader<T> reader(json, value, path);
    describe(reader, static_cast<const T*>(nullptr));
    return value;
}

template <class T>
Json write_struct(const T& value) {
    Json json = Json::object();
    Writer<T> writer(value, json);
    describe(writer, static_cast<const T*>(nullptr));
    return json;
}

template <class T>
Json schema_of_struct() {
    Json schema = object_schema();
    SchemaWriter<T> writer(schema);
    describe(writer, static_cast<const T*>(nullptr));
    return schema;
}

}  // namespace vrut::protocol
