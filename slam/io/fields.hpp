// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <concepts>
#include <optional>
#include <type_traits>
#include <vector>

namespace mh {

// How records are listed. Each struct comes with `fields(record, visit)`, which calls visit(name,
// value) for each field. Its structured binding names every field of the struct, so a field missing
// from the list does not compile. Everything that writes or reads records (results files, JSON,
// maps) is a visitor; a wrapper type in the list can carry more about a value (Digest).

/// T is U or const U: one field list, fields(U&, visit), serves both readers and writers.
template <class T, class U>
concept MaybeConst = std::same_as<std::remove_const_t<T>, U>;

// Type categories that visitors distinguish.
template <class T>
inline constexpr bool kIsVector = false;
template <class T>
inline constexpr bool kIsVector<std::vector<T>> = true;
template <class T>
inline constexpr bool kIsArray = false;
template <class T, std::size_t N>
inline constexpr bool kIsArray<std::array<T, N>> = true;
template <class T>
inline constexpr bool kIsOptional = false;
template <class T>
inline constexpr bool kIsOptional<std::optional<T>> = true;
/// Whether a T shares an immutable record: `*value` is the record, and a T can be constructed from
/// one.
template <class T>
inline constexpr bool kIsShared = false;
/// Whether a record of numbers is written as a list without names, because there are many such
/// records.
template <class T>
inline constexpr bool kAsList = false;

}  // namespace mh
