#pragma once

#include <algorithm>
#include <type_traits>
#include <utility>
#include <vector>

#include "rigid_body_sim/conventions.hpp"

namespace rigid_body_sim {

/// What an effect knows of a body, if it knows nothing.
struct NoData {};
inline bool operator==(const NoData&, const NoData&) { return true; }

template <class Data, class = void>
struct IsComparable : std::false_type {};
template <class Data>
struct IsComparable<Data, std::void_t<decltype(std::declval<Data>() == std::declval<Data>())>>
    : std::true_type {};

/// The bodies that an effect acts on, by ascending index, and what it knows of each.
template <class Data>
class Members {
 public:
  struct Member {
    Eigen::Index body;
    Data data;
  };

  Members() = default;

  std::size_t size() const { return members_.size(); }
  bool empty() const { return members_.empty(); }
  auto begin() const { return members_.begin(); }
  auto end() const { return members_.end(); }

  void add(Eigen::Index body, Data data) {
    if (!members_.empty()) is_even_ = is_even_ && continues(body, data);
    members_.push_back({body, std::move(data)});
  }

  /// What is known of each of them, if that is the same of all and they follow each other.
  const Data* commonData() const {
    return is_even_ && !members_.empty() ? &members_.front().data : nullptr;
  }

  /// f(body, data) for each; f does the same whatever the order. Where the bodies follow each other
  /// and have the same data, as ==, the loop is one that the compiler can turn into SIMD.
  template <class F>
  void forEach(F f) const {
    if (members_.empty()) return;
    if (!is_even_) {
      for (const Member& member : members_) f(member.body, member.data);
      return;
    }
    const Data data = members_.front().data;
    const Eigen::Index end = members_.back().body + 1;
#pragma GCC ivdep
    for (Eigen::Index i = members_.front().body; i < end; ++i) f(i, data);
  }

  /// Those of `some`, whose places in the list become their new indices.
  Members restrictedTo(const std::vector<Eigen::Index>& some) const {
    Members restricted;
    for (std::size_t k = 0; k < some.size(); ++k) {
      const auto found = std::lower_bound(
          members_.begin(), members_.end(), some[k],
          [](const Member& member, Eigen::Index body) { return member.body < body; });
      if (found != members_.end() && found->body == some[k])
        restricted.add(static_cast<Eigen::Index>(k), found->data);
    }
    return restricted;
  }

 private:
  bool continues(Eigen::Index body, const Data& data) const {
    if constexpr (!IsComparable<Data>::value)
      return false;
    else
      return body == members_.back().body + 1 && data == members_.back().data;
  }

  std::vector<Member> members_;
  bool is_even_ = true;
};

}  // namespace rigid_body_sim
