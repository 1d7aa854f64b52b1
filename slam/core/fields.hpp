// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <concepts>
#include <optional>
#include <type_traits>
#include <vector>

namespace mh {

// How records are listed. Beside a struct stands `fields(record, visit)`, which calls
// visit(name, value) for each field. Its brackets name every field of the struct, so that a field
// without a line does not compile. What writes and reads records (results files, JSON, maps) is a
// visitor; a list may say more of a value by its type (Digest).

/// T is U or const U: one list of fields, fields(U&, visit), serves readers and writers.
template <class T, class U>
concept Either = std::same_as<std::remove_const_t<T>, U>;

// What visitors tell apart.
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
/// Whether a record of numbers is written as a list of them, without names: there are many of it.
template <class T>
inline constexpr bool kAsList = false;

}  // namespace mh
