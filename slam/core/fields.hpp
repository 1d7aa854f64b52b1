// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <type_traits>

namespace mh {

/// T is U or const U: one list of fields, fields(U&, visit), serves readers and writers.
template <class T, class U>
concept Either = std::same_as<std::remove_const_t<T>, U>;

}  // namespace mh
