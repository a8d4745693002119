#pragma once

#include <array>
#include <concepts>
#include <cstring>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "json_reader.hpp"

/// What the value of a member may be. A description says it by one of the small structs here, which `bind`
/// makes a Kind for the member's C++ type. For protocol's own .cpp files.
namespace vrut::protocol {

struct FieldTable;

/// Reads, writes and describes values of one C++ type, which it knows by their address.
class Kind {
public:
    virtual ~Kind() = default;
    /// Into a value that is as new. Throws BadJson. Some kinds are written only.
    virtual void read(const Json& json, const std::string& path, void* value) const;
    virtual Json write(const void* value) const = 0;
    virtual Json schema() const = 0;

    // Kinds with members or entries patch each by itself; others read the whole.
    virtual void patch(void* value, const void* start, const Json& json, const std::string& path) const;
    /// From what write() made. A value of the scene's own may lie beyond what clients may say.
    virtual void restore(void* value, const Json& json, const std::string& path) const;
    virtual Json patch_schema() const { return schema(); }
    /// Of the object's members; null: it has none.
    virtual const FieldTable* members() const { return nullptr; }
};
/// Kinds are made once, with the tables of fields, and stay.
using KindPtr = const Kind*;

KindPtr keep(std::unique_ptr<const Kind> kind);
template <class Made, class... Arguments>
KindPtr made(Arguments&&... arguments) {
    return keep(std::make_unique<const Made>(std::forward<Arguments>(arguments)...));
}

/// Names a C++ type.
template <class T>
struct Of {};

// --- as descriptions say them

struct Number {
    double min, max;
};
struct Integer {
    std::int64_t min = 0, max = kMaxInteger;
};
struct Flag {};
/// At most `max` bytes of UTF-8.
struct Text {
    std::size_t max;
    std::span<const char* const> codes = {};  ///< all that the server says; empty: anything
};
/// An enumerator by its name: words[0] is that of value 0.
template <std::size_t N>
struct Word {
    std::array<std::string_view, N> words;
};
template <class... Words>
constexpr Word<sizeof...(Words)> word(Words... words) {
    return {{words...}};
}
/// As many numbers as the glm vector has.
struct Vector {
    double min, max;
};
/// 16 numbers row by row.
struct Matrix {
    double max;  ///< of each number's size
};
template <class Element>
struct List {
    Element element;
    std::size_t min, max;
};
template <class Element>
List(Element, std::size_t, std::size_t) -> List<Element>;
struct Object {
    const char* name = nullptr;              ///< of the schema's definition; null: it stands where it is used
    const FieldTable& (*table)() = nullptr;  ///< null: that of the member's type
};
/// An object that patches change member by member.
struct Section {
    const char* name = nullptr;  ///< as Object's
};
/// {"ID or NAME": entry}, to be written only.
template <class Entry>
struct Table {
    Entry entry;
};
template <class Entry>
Table(Entry) -> Table<Entry>;
/// Objects by name that are the scene's own: none is added or removed, and null gives one back what it was at
/// the start.
struct Items {};
/// Objects by name that are the clients' own: a patch adds some, and null removes one, or gives it back where
/// it was there at the start.
struct Entries {
    std::size_t max = 0;             ///< 0: any number
    const char* required = nullptr;  ///< what a new one must have
};
/// Any object, kept as it is.
struct AnyObject {
    const char* name;  ///< of the schema's definition
};

// --- and as kinds

Json schema_of(const Number& number);
Json schema_of(const Integer& integer);
Json schema_of(const Text& text);
/// {"anyOf": [null, …]}.
Json nullable(Json schema);

KindPtr bind(const Number& number, Of<double>);
KindPtr bind(const Flag& flag, Of<bool>);
KindPtr bind(const Text& text, Of<std::string>);
KindPtr bind(const Matrix& matrix, Of<glm::dmat4>);
KindPtr bind(const AnyObject& object, Of<std::shared_ptr<const Json>>);

KindPtr integer_kind(const Integer& integer, void (*store)(void* value, std::int64_t),
                     Json (*load)(const void* value));
template <std::integral T>
KindPtr bind(const Integer& integer, Of<T>) {
    return integer_kind(
        integer, [](void* value, std::int64_t read) { *static_cast<T*>(value) = static_cast<T>(read); },
        [](const void* value) -> Json { return *static_cast<const T*>(value); });
}

/// Of an enumeration that is an int.
KindPtr word_kind(std::span<const std::string_view> words);
template <class T, std::size_t N>
KindPtr bind(const Word<N>& word, Of<T>) {
    static_assert(std::is_same_v<std::underlying_type_t<T>, int>);
    return word_kind(word.words);
}

/// Of so many doubles in a row.
KindPtr vector_kind(const Vector& vector, std::size_t length);
template <class T>
KindPtr bind(const Vector& vector, Of<T>) {
    static_assert(std::is_same_v<typename T::value_type, double>);
    return vector_kind(vector, static_cast<std::size_t>(T::length()));
}

using TableGetter = const FieldTable& (*)();
KindPtr object_kind(const Object& object, TableGetter table);
KindPtr section_kind(const Section& section, TableGetter table);

/// Of a std::vector.
struct ListType {
    std::size_t (*size)(const void* list);
    const void* (*at)(const void* list, std::size_t i);
    void (*clear)(void* list);
    void* (*add)(void* list);  ///< a new element at the end
};
KindPtr list_kind(const ListType& type, KindPtr element, std::size_t min, std::size_t max);

/// Of a SharedMap and the std::map in it.
using ForEachEntry = void (*)(const void* shared,
                              const std::function<void(const std::string&, const void*)>& use);
struct MapType {
    ForEachEntry for_each;
    const void* (*find_shared)(const void* shared, const std::string& key);  ///< null: there is none
    /// Gives a copy of the map to `change`, and shares that.
    void (*change)(void* shared, const std::function<void(void* map)>& change);
    std::size_t (*size)(const void* map);
    void* (*find)(void* map, const std::string& key);  ///< null: there is none
    void* (*add)(void* map, const std::string& key);   ///< or what is there
    void (*erase)(void* map, const std::string& key);
    void (*clear)(void* map);
    void (*copy)(void* to, const void* from);  ///< of entries
};
KindPtr table_kind(ForEachEntry for_each, KindPtr entry);
KindPtr items_kind(const MapType& type, TableGetter table);
KindPtr entries_kind(const MapType& type, TableGetter table, const Entries& entries);

KindPtr shared_kind(const void* (*value_in)(const void* shared), KindPtr kind);

}  // namespace vrut::protocol
