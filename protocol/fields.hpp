#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "kinds.hpp"
#include "state.hpp"

/// The members of what travels. `describe(Fields<T>&)` names those of a struct once, with the kind and the
/// meaning of each; they become a table at the first use. Reading, writing, patching and the JSON Schema are
/// loops over such a table, and the tables in the pages beside this file follow from the schema. For
/// protocol's own .cpp files.
namespace vrut::protocol {

/// What can be done with a value of a member's C++ type, given its address. Null: the type cannot do it, or
/// nobody needs it.
struct Type {
    bool (*empty)(const void* value);
    bool (*equal)(const void* a, const void* b);
    void (*copy)(void* to, const void* from);
    // Of std::optional:
    const void* (*held)(const void* optional);  ///< what it holds, null: nothing
    void* (*hold)(void* optional);              ///< makes it hold something, and tells where
    void (*reset)(void* optional);
};

/// If a member has to be there.
enum class Presence {
    required,  ///< when it is read, too
    optional,  ///< no; where it has its default it is left out
    lasting,   ///< always written, and where it is not read, it stays as it is
};

/// What holds for a member of the state besides, as a sum.
enum Rules : unsigned {
    none = 0,
    read_only = 1,
    kept = 2,            ///< with the scene, where a server keeps what clients change
    for_hosts = 4,       ///< what hosts may patch, too
    in_cues = 8,         ///< part of what a cue shows
    survives_open = 16,  ///< stays as it is when another scene is opened
    from_nothing = 32,   ///< of an entry that starts with what is shown: what a patch gives is all of it
};

struct Field {
    const char* name;
    const char* meaning;
    KindPtr kind;
    const Type* type;
    std::size_t offset;  ///< bytes from the struct's address
    Presence presence;
    unsigned rules;  ///< Rules

    bool has(Rules rule) const { return (rules & rule) != 0; }
    void* in(void* object) const { return static_cast<std::byte*>(object) + offset; }
    const void* in(const void* object) const { return static_cast<const std::byte*>(object) + offset; }
    /// Where its value is; null: it has none.
    const void* value_in(const void* object) const;
};

/// Of one struct.
struct FieldTable {
    const void* defaults;  ///< a value of the struct in which each member has its default
    std::vector<Field> fields;
};

// --- loops over a table; `path` leads to the object, and is empty at the top

/// Fills a struct; what is not described is ignored. Throws BadJson.
void read_fields(const FieldTable& table, void* target, const Json& object, const std::string& path);
Json write_fields(const FieldTable& table, const void* object);
Json schema_of(const FieldTable& table);
/// A merge patch (RFC 7396): null gives a member back what it has in `start`. Throws BadJson, also for
/// members that are not described or read-only.
void patch_fields(const FieldTable& table, void* target, const void* start, const Json& patch,
                  const std::string& path);
/// From a document as write_fields() made it: what clients may change, over what is there. What may be absent
/// and is gets empty. Throws BadJson.
void restore_fields(const FieldTable& table, void* target, const Json& document, const std::string& path);
/// Of a patch: nothing need be there, anything may be null, nothing else may be there.
Json patch_schema_of(const FieldTable& table);
/// Copies each member with this rule from one value to another; of an object that has not itself the rule,
/// those within.
void copy_fields(const FieldTable& table, Rules rule, void* to, const void* from);
/// Between values of two structs: members of one name and type, where one of the two has this rule; and
/// within objects of one name.
void copy_common_fields(Rules rule, const FieldTable& to_table, void* to, const FieldTable& from_table,
                        const void* from);

/// What must be merged into `from` to make `to` of it (RFC 7396); neither holds a null.
Json merge_diff(const Json& from, const Json& to);

// --- tables of C++ types

template <class T>
concept HasEquality = requires(const T& a) {
    a == a;
};
template <class T>
struct IsComparable : std::bool_constant<HasEquality<T>> {};
template <class T>
struct IsComparable<std::vector<T>> : IsComparable<T> {};
template <class T>
struct IsComparable<std::optional<T>> : IsComparable<T> {};
template <class Key, class T>
struct IsComparable<std::map<Key, T>> : IsComparable<T> {};

template <class T>
constexpr void add_comparison(Type& type) {
    if constexpr (requires(const T& value) { value.empty(); })
        type.empty = [](const void* value) { return static_cast<const T*>(value)->empty(); };
    if constexpr (IsComparable<T>::value)
        type.equal = [](const void* a, const void* b) {
            return *static_cast<const T*>(a) == *static_cast<const T*>(b);
        };
}
template <class T>
constexpr void add_optional(Type& type) {
    if constexpr (requires(T & value) { value.has_value(); }) {
        type.held = [](const void* value) -> const void* {
            const T& optional = *static_cast<const T*>(value);
            return optional ? &*optional : nullptr;
        };
        type.hold = [](void* value) -> void* {
            T& optional = *static_cast<T*>(value);
            optional = typename T::value_type{};
            return &*optional;
        };
    }
}
/// Comparisons and copies are compiled only where this presence needs them.
template <class T, Presence presence>
const Type* type_of() {
    static constexpr Type type = [] {
        Type made{};
        add_optional<T>(made);
        if constexpr (presence != Presence::required) add_comparison<T>(made);
        if constexpr (presence == Presence::lasting) {
            made.copy = [](void* to, const void* from) {
                *static_cast<T*>(to) = *static_cast<const T*>(from);
            };
            if constexpr (requires(T & value) {
                              value.reset();
                              value.has_value();
                          })
                made.reset = [](void* value) { static_cast<T*>(value)->reset(); };
        }
        return made;
    }();
    return &type;
}

template <class T>
struct Held {
    using type = T;
};
template <class T>
struct Held<std::optional<T>> {
    using type = T;
};

template <class T>
const FieldTable& table_of();

template <class Kind, class T>
KindPtr kind_of_value(const Kind& kind, Of<T> type) {
    return bind(kind, type);
}
/// What is shared because it is large and seldom changes is written only.
template <class Kind, class T>
KindPtr kind_of_value(const Kind& kind, Of<Shared<T>>) {
    return shared_kind(
        [](const void* shared) -> const void* { return static_cast<const Shared<T>*>(shared)->value.get(); },
        bind(kind, Of<T>{}));
}
/// Of a member's value, where that may hold none.
template <class Member, class Kind>
KindPtr kind_for(const Kind& kind) {
    return kind_of_value(kind, Of<typename Held<Member>::type>{});
}

/// Takes the members of a struct, in their order. What does not depend on their types is compiled once.
class FieldList {
public:
    explicit FieldList(FieldTable& table) : table_(table) {}

protected:
    void add(const char* name, KindPtr kind, const Type* type, const void* member, const char* meaning,
             Presence presence, unsigned rules);
    void inline_fields(const FieldTable& part, const void* member);

private:
    FieldTable& table_;
};

template <class T>
class Fields : public FieldList {
public:
    explicit Fields(FieldTable& table)
        : FieldList(table), defaults_(*static_cast<const T*>(table.defaults)) {}

    template <class Member, class Owner, class Kind>
    void required(const char* name, Member Owner::*member, const Kind& kind, const char* meaning) {
        add(name, kind_for<Member>(kind), type_of<Member, Presence::required>(), &(defaults_.*member),
            meaning, Presence::required, none);
    }
    template <class Member, class Owner, class Kind>
    void optional(const char* name, Member Owner::*member, const Kind& kind, const char* meaning) {
        add(name, kind_for<Member>(kind), type_of<Member, Presence::optional>(), &(defaults_.*member),
            meaning, Presence::optional, none);
    }
    /// Of the state: clients may patch it.
    template <class Member, class Owner, class Kind>
    void writable(const char* name, Member Owner::*member, const Kind& kind, const char* meaning,
                  unsigned rules = none) {
        add(name, kind_for<Member>(kind), type_of<Member, Presence::lasting>(), &(defaults_.*member), meaning,
            Presence::lasting, rules);
    }
    /// Of the state: the server's alone.
    template <class Member, class Owner, class Kind>
    void fixed(const char* name, Member Owner::*member, const Kind& kind, const char* meaning,
               unsigned rules = none) {
        writable(name, member, kind, meaning, rules | read_only);
    }
    /// Members that stand in the same object.
    template <class Member, class Owner>
    void inlined(Member Owner::*member) {
        inline_fields(table_of<Member>(), &(defaults_.*member));
    }

private:
    const T& defaults_;
};

const FieldTable& made_table(const void* defaults, void (*describe)(FieldTable& table));

/// Is made at the first call, and stays.
template <class T>
const FieldTable& table_of() {
    static const FieldTable& table = made_table(new T{}, [](FieldTable& made) {
        Fields<T> fields(made);
        describe(fields);
    });
    return table;
}

template <class T>
const FieldTable& table_of_value(const T&) {
    return table_of<T>();
}

/// Throws BadJson.
template <class T>
T read_struct(const Json& json, const std::string& path) {
    T value{};
    read_fields(table_of<T>(), &value, read_object(json, path.empty() ? "message" : path), path);
    return value;
}

template <class T>
Json write_struct(const T& value) {
    return write_fields(table_of<T>(), &value);
}

template <class T>
Json schema_of_struct() {
    return schema_of(table_of<T>());
}

template <class T>
void patch_struct(T& target, const T& start, const Json& patch, const std::string& path) {
    patch_fields(table_of<T>(), &target, &start, patch, path);
}

// --- kinds of members whose C++ types have templates

template <class T>
KindPtr bind(const Object& object, Of<T>) {
    return object_kind(object, object.table ? object.table : &table_of<T>);
}
template <class T>
KindPtr bind(const Section& section, Of<T>) {
    return section_kind(section, &table_of<T>);
}

template <class T, class Element>
KindPtr bind(const List<Element>& list, Of<std::vector<T>>) {
    using Values = std::vector<T>;
    static constexpr ListType type{
        [](const void* values) { return static_cast<const Values*>(values)->size(); },
        [](const void* values, std::size_t i) -> const void* {
            return &(*static_cast<const Values*>(values))[i];
        },
        [](void* values) { static_cast<Values*>(values)->clear(); },
        [](void* values) -> void* { return &static_cast<Values*>(values)->emplace_back(); }};
    return list_kind(type, bind(list.element, Of<T>{}), list.min, list.max);
}

template <class T>
const std::map<std::string, T>& map_in(const std::map<std::string, T>& map) {
    return map;
}
template <class T>
const std::map<std::string, T>& map_in(const SharedMap<T>& shared) {
    return *shared;
}
template <class Holder>
void for_each_entry(const void* holder, const std::function<void(const std::string&, const void*)>& use) {
    for (const auto& [key, value] : map_in(*static_cast<const Holder*>(holder))) use(key, &value);
}

template <class T, class Entry>
KindPtr bind(const Table<Entry>& table, Of<std::map<std::string, T>>) {
    return table_kind(&for_each_entry<std::map<std::string, T>>, bind(table.entry, Of<T>{}));
}
template <class T, class Entry>
KindPtr bind(const Table<Entry>& table, Of<SharedMap<T>>) {
    return table_kind(&for_each_entry<SharedMap<T>>, bind(table.entry, Of<T>{}));
}

template <class T>
MapType map_type() {
    using Map = std::map<std::string, T>;
    using Shared = SharedMap<T>;
    return {&for_each_entry<Shared>,
            [](const void* shared, const std::string& key) -> const void* {
                const auto found = (*static_cast<const Shared*>(shared))->find(key);
                return found == (*static_cast<const Shared*>(shared))->end() ? nullptr : &found->second;
            },
            [](void* shared, const std::function<void(void*)>& change) {
                Map map = **static_cast<Shared*>(shared);
                change(&map);
                static_cast<Shared*>(shared)->set(std::move(map));
            },
            [](const void* map) { return static_cast<const Map*>(map)->size(); },
            [](void* map, const std::string& key) -> void* {
                const auto found = static_cast<Map*>(map)->find(key);
                return found == static_cast<Map*>(map)->end() ? nullptr : &found->second;
            },
            [](void* map, const std::string& key) -> void* { return &(*static_cast<Map*>(map))[key]; },
            [](void* map, const std::string& key) { static_cast<Map*>(map)->erase(key); },
            [](void* map) { static_cast<Map*>(map)->clear(); },
            [](void* to, const void* from) { *static_cast<T*>(to) = *static_cast<const T*>(from); }};
}
template <class T>
KindPtr bind(const Items&, Of<SharedMap<T>>) {
    return items_kind(map_type<T>(), &table_of<T>);
}
template <class T>
KindPtr bind(const Entries& entries, Of<SharedMap<T>>) {
    return entries_kind(map_type<T>(), &table_of<T>, entries);
}

}  // namespace vrut::protocol
