// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/generate.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include "scenes/dice.hpp"
#include "scenes/generate/grammar.hpp"
#include "scenes/generate/layout.hpp"
#include "scenes/house.hpp"
#include "scenes/name_key.hpp"
#include "slam/core/error.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kTries = 24;           // places tried for one piece
constexpr int kDrafts = 400;         // rooms drawn until one holds all that it needs
constexpr double kLeastFree = 0.07;  // of the floor: where the robot can stand
constexpr double kDegree = std::numbers::pi / 180.0;

/// Plans are written in whole millimeters: what is checked is what is read back.
double whole_mm(double m) {
  return std::round(m * 1000.0) / 1000.0;
}
double half_degrees(double deg) {
  return std::round(deg * 2.0) / 2.0;
}

double draw(Dice& dice, const DrawRange& range) {
  return dice.number(range.low, range.high);
}
int draw_count(Dice& dice, const DrawRange& range) {
  return dice.whole(static_cast<int>(std::lround(range.low)),
                    static_cast<int>(std::lround(range.high)));
}

/// One attempt at a room.
class Maker {
 public:
  Maker(const RoomGrammar& grammar, Dice dice, int group)
      : grammar_(grammar), dice_(dice), group_(group), layout_(draw_shape()) {}

  /// @returns whether all that the room needs found a place
  bool furnish() {
    if (!add_doors()) return false;
    add_windows();
    choose_surfaces();
    if (!add_lamps()) return false;
    const double area = layout_.floor_area_m2();
    constexpr std::array<DrawRange, kDensityGroups> kRatios = {
        {{1.5, 3.9}, {4.1, 7.9}, {8.2, 15.8}, {16.3, 34.0}}};
    const double ratio = draw(dice_, kRatios[static_cast<std::size_t>(group_)]);
    target_ = std::max(3, static_cast<int>(ratio * area / 10.0));
    for (const ItemRule& rule : grammar_.furniture)
      if (!place_rule(rule)) return false;
    add_extras();
    fitting_ = true;
    for (const ItemRule& rule : grammar_.fittings) place_rule(rule);
    return density_group(10.0 * layout_.object_count() / area) == group_ &&
           layout_.free_share() >= kLeastFree;
  }

  GeneratedPlan plan(const std::string& name) const {
    return {.name = name,
            .room = grammar_.name,
            .yaml = text(name),
            .floor_area_m2 = layout_.floor_area_m2(),
            .objects = layout_.object_count(),
            .fittings =
                static_cast<int>(std::ranges::count(layout_.items(), true, &LayoutItem::fitting)),
            .free_share = layout_.free_share()};
  }

 private:
  // ---- the empty room ------------------------------------------------------------------------

  Layout draw_shape() {
    // Few objects per area are found in large rooms, many in small ones.
    const double span = grammar_.area_m2.high - grammar_.area_m2.low;
    constexpr std::array<DrawRange, kDensityGroups> kPart = {
        {{0.55, 1.0}, {0.2, 1.0}, {0.0, 0.85}, {0.0, 0.45}}};
    double area =
        grammar_.area_m2.low + span * draw(dice_, kPart[static_cast<std::size_t>(group_)]);
    const double aspect = draw(dice_, grammar_.aspect);
    const bool missing = dice_.chance(grammar_.cut_chance);
    const double a = draw(dice_, grammar_.cut_share), b = draw(dice_, grammar_.cut_share);
    if (missing) area /= 1.0 - a * b;
    double w = whole_mm(std::sqrt(area * aspect)), d = whole_mm(area / w);
    if (dice_.chance(0.5)) std::swap(w, d);
    const double height = whole_mm(draw(dice_, grammar_.height_m));
    std::optional<FloorRect> cut;
    constexpr double kLeft_m = 1.2, kLeast_m = 0.4;  // beside what is missing, and of it
    const double cw = whole_mm(std::min(a * w, w - kLeft_m));
    const double cd = whole_mm(std::min(b * d, d - kLeft_m));
    if (missing && cw > kLeast_m && cd > kLeast_m) {
      const bool south = dice_.chance(0.5), west = dice_.chance(0.5);
      cut = FloorRect{west ? 0 : w - cw, south ? 0 : d - cd, west ? cw : w, south ? cd : d};
    }
    return {w, d, height, cut};
  }

  const WallRun& any_outer_wall() { return layout_.walls()[dice_.below(4)]; }

  bool add_doors() {
    const int count = draw_count(dice_, grammar_.doors);
    for (int i = 0; i < count; ++i) {
      bool placed = false;
      for (int t = 0; t < kTries && !placed; ++t) {
        const WallRun& wall = any_outer_wall();
        const double width = whole_mm(dice_.number(0.8, 0.95));
        if (wall.to_m - wall.from_m < width + 0.3) continue;
        // Doors are mostly near a corner.
        double from = dice_.number(wall.from_m + 0.13, wall.to_m - 0.13 - width);
        if (dice_.chance(0.6))
          from = dice_.chance(0.5) ? wall.from_m + 0.2 : wall.to_m - 0.2 - width;
        from = whole_mm(from);
        placed = layout_.add_opening(wall, {.name = fmt::format("door_{}", i + 1),
                                            .from_m = from,
                                            .to_m = whole_mm(from + width),
                                            .low_m = 0,
                                            .high_m = whole_mm(dice_.number(2.0, 2.1)),
                                            .door = true});
      }
      if (!placed && i == 0) return false;
    }
    return true;
  }

  void add_windows() {
    const int count = draw_count(dice_, grammar_.windows);
    const Side main_side = any_outer_wall().side;
    for (int i = 0; i < count; ++i)
      for (int t = 0; t < kTries; ++t) {
        const WallRun& wall = dice_.chance(0.7)
                                  ? layout_.walls()[static_cast<std::size_t>(main_side)]
                                  : any_outer_wall();
        const double width = whole_mm(draw(dice_, grammar_.window_width_m));
        const double low = whole_mm(draw(dice_, grammar_.window_sill_m));
        const double high = whole_mm(std::min(
            std::max(low + 0.35, draw(dice_, grammar_.window_head_m)), layout_.height_m() - 0.12));
        if (wall.to_m - wall.from_m < width + 0.3) continue;
        const double from = whole_mm(dice_.number(wall.from_m + 0.13, wall.to_m - 0.13 - width));
        if (layout_.add_opening(wall, {.name = fmt::format("window_{}", i + 1),
                                       .from_m = from,
                                       .to_m = whole_mm(from + width),
                                       .low_m = low,
                                       .high_m = high}))
          break;
      }
  }

  // ---- materials -----------------------------------------------------------------------------

  /// Some stuff of a palette under a name that says which.
  std::string material_of(const std::string& palette, const PaletteEntry& entry, Rgb8 tone,
                          double variation, int piece) {
    // Two pieces of one stuff differ a little in shade, and in their grain.
    const double shade = dice_.number(-0.035, 0.035) * (piece > 0 ? 1.0 : 0.0);
    const auto level = [&](std::uint8_t v) {
      return std::clamp(static_cast<int>(std::lround(v * (1.0 + shade))), 0, 255);
    };
    const std::string value = fmt::format(
        "{{kind: {}, tone: [{}, {}, {}], variation: {:.2f}, seed: {}}}", entry.kind, level(tone.r),
        level(tone.g), level(tone.b), variation, dice_.whole(1, 999'999));
    const std::string name = fmt::format("{}_{}", palette, materials_.size() + 1);
    materials_.emplace_back(name, value);
    return name;
  }

  struct Base {
    const PaletteEntry* entry;
    Rgb8 tone;
    double variation;
    std::vector<std::string> made;  ///< names of materials
  };

  Base draw_base(const std::string& palette) {
    const std::vector<PaletteEntry>& list = palettes().lists.at(palette);
    const PaletteEntry& entry = list[dice_.below(list.size())];
    const Rgb8 tone = entry.tones[dice_.below(entry.tones.size())];
    const auto near = [&](std::uint8_t v) {
      return static_cast<std::uint8_t>(std::clamp(v + dice_.whole(-9, 9), 0, 255));
    };
    const Rgb8 shifted{near(tone.r), near(tone.g), near(tone.b)};
    return {&entry, shifted, draw(dice_, entry.variation), {}};
  }

  /// A material of that palette: mostly of the stuff that the rest of the room is made of.
  std::string material(const std::string& palette) {
    constexpr std::size_t kPiecesOfOneStuff = 3;
    const auto& fresh = palettes().fresh;
    if (std::ranges::find(fresh, palette) != fresh.end()) {
      const Base base = draw_base(palette);
      return material_of(palette, *base.entry, base.tone, base.variation, 0);
    }
    std::vector<Base>& known = bases_[palette];
    if (known.empty() || (known.size() < 4 && dice_.chance(0.2)))
      known.push_back(draw_base(palette));
    Base& base = dice_.chance(0.65) ? known.front() : known[dice_.below(known.size())];
    if (base.made.size() < kPiecesOfOneStuff)
      base.made.push_back(material_of(palette, *base.entry, base.tone, base.variation,
                                      static_cast<int>(base.made.size())));
    return base.made[dice_.below(base.made.size())];
  }

  std::string surface(const std::vector<std::string>& lists) {
    const std::string palette = lists[dice_.below(lists.size())];
    const Base base = draw_base(palette);
    return material_of(palette, *base.entry, base.tone, base.variation, 0);
  }

  void choose_surfaces() {
    floor_ = surface(grammar_.floors);
    wall_ = surface(grammar_.walls);
    ceiling_ = surface(grammar_.ceilings);
    if (dice_.chance(grammar_.accent_chance)) {
      accent_ = surface(grammar_.walls);
      accent_side_ = any_outer_wall().side;
    }
    trim_ = surface({"trims"});
    frame_ = surface({"trims"});
    garden_ = surface({"gardens"});
  }

  std::map<std::string, std::string> materials_for(const ItemRule& rule,
                                                   const FurnitureKind& kind) {
    std::map<std::string, std::string> chosen;
    std::string_view rest = kind.roles;
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find(' '), rest.size());
      const std::string role(rest.substr(0, end));
      rest.remove_prefix(std::min(rest.size(), end + 1));
      const auto in = [&](const std::map<std::string, std::string>& roles) {
        const auto found = roles.find(role);
        if (found == roles.end()) return false;
        chosen[role] = material(found->second);
        return true;
      };
      if (!in(rule.materials) && !in(grammar_.roles)) in(palettes().list_of_role);
    }
    return chosen;
  }

  // ---- furniture -----------------------------------------------------------------------------

  /// What the pieces of one rule have in common, unless its kind is a varied one.
  struct Design {
    const ItemRule* rule;
    const FurnitureKind* kind;
    Vector3d size_m;
    std::map<std::string, std::string> materials;
  };

  Design design(const ItemRule& rule) {
    Design result{&rule, find_furniture(rule.kinds[dice_.below(rule.kinds.size())]), {}, {}};
    const Eigen::Vector3f& usual = result.kind->size_m;
    for (int k = 0; k < 3; ++k)
      result.size_m[k] =
          whole_mm(rule.size_m ? draw(dice_, (*rule.size_m)[static_cast<std::size_t>(k)])
                               : usual[k] * dice_.number(0.94, 1.06));
    result.materials = materials_for(rule, *result.kind);
    return result;
  }

  /// For the i-th piece of a rule: sets match, but no two pictures or cushions are alike.
  Design design_of_piece(const Design& common, int i) {
    const bool varied =
        std::ranges::find(palettes().varied, common.kind->name) != palettes().varied.end();
    return i > 0 && varied ? design(*common.rule) : common;
  }

  LayoutItem item_of(const Design& d) {
    LayoutItem item;
    item.kind = d.kind;
    item.size_m = d.size_m;
    item.materials = d.materials;
    item.fitting = fitting_ || d.rule->fitting;
    item.name = fmt::format("{}_{}", d.kind->name, ++counts_[std::string(d.kind->name)]);
    if (d.kind->bulb && d.kind->mount != Mount::kCeiling) {
      const double power = dice_.number(0.12, 0.26);
      item.glow = Vector3d(power, 0.82 * power, 0.56 * power);
    }
    return item;
  }

  std::optional<std::size_t> add(const LayoutItem& item, const Design& d) {
    const auto added = layout_.add(item, d.rule->front_m);
    if (!added) --counts_[std::string(d.kind->name)];
    return added;
  }

  bool full() const { return !fitting_ && layout_.object_count() >= target_; }

  /// @returns false if something that the room needs has no place
  bool place_rule(const ItemRule& rule) {
    const bool wanted = dice_.chance(rule.chance);
    if (!rule.need && (!wanted || full())) return true;
    const int count = draw_count(dice_, rule.count);
    const Design common = design(rule);
    if (rule.place == Place::kRows || rule.place == Place::kAisles) {
      const int placed = rule.place == Place::kRows ? rows(common) : aisles(common);
      return placed > 0 || !rule.need;
    }
    if (rule.place == Place::kAlong) {
      for (int i = 0; i < count; ++i) along_wall(common);
      return true;
    }
    if (rule.place == Place::kWindow) {
      at_windows(common);
      return true;
    }
    if (rule.place == Place::kDoor) {
      at_doors(common);
      return true;
    }
    int placed = 0;
    for (int i = 0; i < count && (placed == 0 || rule.need || !full()); ++i)
      if (const auto index = place_one(design_of_piece(common, i))) {
        ++placed;
        place_parts(rule, *index);
      }
    return placed > 0 || !rule.need || count == 0;
  }

  std::optional<std::size_t> place_one(const Design& d) {
    for (int t = 0; t < kTries; ++t) {
      LayoutItem item = item_of(d);
      if (aim(d, item))
        if (const auto index = add(item, d)) return index;
      if (!aimed_) --counts_[std::string(d.kind->name)];
    }
    return std::nullopt;
  }

  /// Draws a place for a piece that stands for itself. aimed_ tells whether there was any.
  bool aim(const Design& d, LayoutItem& item) {
    aimed_ = false;
    const ItemRule& rule = *d.rule;
    const double w = d.size_m.x(), depth = d.size_m.y();
    const double extra = half_degrees(draw(dice_, rule.turn_deg));
    const FloorRect& r = layout_.rect();
    switch (rule.place) {
      case Place::kWall:
      case Place::kHang:
      case Place::kCorner: {
        const WallRun& wall = layout_.walls()[dice_.below(layout_.walls().size())];
        const double c = std::abs(std::cos(extra * kDegree)),
                     s = std::abs(std::sin(extra * kDegree));
        const double across = c * w + s * depth, deep = s * w + c * depth;
        const double low = wall.from_m + across / 2 + 0.02, high = wall.to_m - across / 2 - 0.02;
        if (high < low) return false;
        double along = dice_.number(low, high);
        if (rule.place == Place::kCorner) along = dice_.chance(0.5) ? low : high;
        // Furniture stands side by side rather than a hand's breadth apart.
        if (rule.place == Place::kWall && dice_.chance(0.35))
          along = dice_.chance(0.5) ? low : high;
        const double gap = rule.place == Place::kHang ? 0.002 : draw(dice_, rule.gap_m);
        item.at_m = wall.place(along, deep, gap);
        item.turn_deg = wall.turn_deg() + extra;
        item.z_m = rule.z_m ? whole_mm(draw(dice_, *rule.z_m)) : 0.0;
        break;
      }
      case Place::kCenter: {
        item.at_m = {0.5 * (r.x0 + r.x1) * dice_.number(0.8, 1.2),
                     0.5 * (r.y0 + r.y1) * dice_.number(0.8, 1.2)};
        const bool along_x = r.x1 - r.x0 > r.y1 - r.y0;
        item.turn_deg = (along_x == (w > depth) ? 0.0 : 90.0) + (dice_.chance(0.5) ? 180.0 : 0.0);
        item.turn_deg += extra;
        break;
      }
      case Place::kFloor:
        item.at_m = {dice_.number(r.x0, r.x1), dice_.number(r.y0, r.y1)};
        item.turn_deg = extra != 0 ? extra : 90.0 * dice_.whole(0, 3);
        break;
      case Place::kCeiling:
        item.at_m = {dice_.number(r.x0, r.x1), dice_.number(r.y0, r.y1)};
        item.z_m = layout_.height_m() - item.size_m.z();
        break;
      case Place::kOnAny: {
        std::vector<std::size_t> carriers;
        for (std::size_t i = 0; i < layout_.items().size(); ++i)
          if (std::ranges::find(rule.carriers, layout_.item(i).kind->name) != rule.carriers.end())
            carriers.push_back(i);
        if (carriers.empty()) return false;
        if (!put_on(d, carriers[dice_.below(carriers.size())], item)) return false;
        break;
      }
      default:
        return false;
    }
    item.at_m = {whole_mm(item.at_m.x()), whole_mm(item.at_m.y())};
    aimed_ = true;
    return true;
  }

  /// Somewhere on a carrier, within the rule's zone.
  bool put_on(const Design& d, std::size_t carrier_index, LayoutItem& item) {
    const LayoutItem& carrier = layout_.item(carrier_index);
    const ItemRule& rule = *d.rule;
    item.on_turn_deg = half_degrees(draw(dice_, rule.turn_deg));
    const double c = std::abs(std::cos(item.on_turn_deg * kDegree));
    const double s = std::abs(std::sin(item.on_turn_deg * kDegree));
    const Vector2d half(0.5 * (c * d.size_m.x() + s * d.size_m.y()),
                        0.5 * (s * d.size_m.x() + c * d.size_m.y()));
    const Vector2d own = 0.5 * carrier.size_m.head<2>();
    Vector2d low(rule.zone[0] * own.x(), rule.zone[1] * own.y());
    Vector2d high(rule.zone[2] * own.x(), rule.zone[3] * own.y());
    low += half, high -= half;
    constexpr double kOver_m = 0.02;  // what stands at the edge
    for (int k = 0; k < 2; ++k) {
      if (high[k] < low[k] - kOver_m) return false;
      if (high[k] < low[k]) low[k] = high[k] = 0.5 * (low[k] + high[k]);
      item.on_at_m[k] = whole_mm(dice_.number(low[k], high[k]));
    }
    item.on = carrier_index;
    item.on_board = rule.z_m.has_value();
    const double up = rule.z_m ? whole_mm(draw(dice_, *rule.z_m)) : carrier.size_m.z();
    item.z_m = carrier.z_m + up;
    item.at_m = from_frame(carrier.at_m, carrier.turn_deg, item.on_at_m);
    item.turn_deg = carrier.turn_deg + item.on_turn_deg;
    return true;
  }

  // ---- pieces that belong to another ---------------------------------------------------------

  void place_parts(const ItemRule& owner, std::size_t index) {
    for (const ItemRule& rule : owner.with) {
      const bool wanted = dice_.chance(rule.chance);
      if (!rule.need && (!wanted || (full() && !rule.fitting))) continue;
      const int count = draw_count(dice_, rule.count);
      const Design common = design(rule);
      if (rule.place == Place::kAround) {
        around(common, index, count);
        continue;
      }
      for (int i = 0; i < count; ++i) {
        const Design d = design_of_piece(common, i);
        for (int t = 0; t < kTries; ++t) {
          LayoutItem item = item_of(d);
          const bool aimed = aim_part(d, index, item);
          if (!aimed) {
            --counts_[std::string(d.kind->name)];
            continue;
          }
          if (const auto added = add(item, d)) {
            place_parts(rule, *added);
            break;
          }
        }
      }
    }
  }

  bool aim_part(const Design& d, std::size_t owner_index, LayoutItem& item) {
    const LayoutItem& owner = layout_.item(owner_index);
    const ItemRule& rule = *d.rule;
    if (rule.place == Place::kOn) return put_on(d, owner_index, item);
    const double gap = draw(dice_, rule.gap_m);
    const double extra = half_degrees(draw(dice_, rule.turn_deg));
    Vector2d local = Vector2d::Zero();
    double turn = 0;
    if (rule.z_m) item.z_m = whole_mm(draw(dice_, *rule.z_m));
    const double slack = dice_.number(rule.zone[0], rule.zone[2]);  // sideways, in half sizes
    switch (rule.place) {
      case Place::kBeside: {
        const double side = dice_.chance(0.5) ? 1.0 : -1.0;
        local.x() = side * (0.5 * (owner.size_m.x() + d.size_m.x()) + gap);
        local.y() = 0.5 * (owner.size_m.y() - d.size_m.y());  // backs in line
        break;
      }
      case Place::kFront:  // faces its owner, as a chair does a desk
        local.y() = -(0.5 * (owner.size_m.y() + d.size_m.y()) + gap);
        local.x() = rule.zone[0] <= -1 ? 0.0 : slack * 0.5 * owner.size_m.x();
        turn = 180.0;
        break;
      case Place::kAbove:
        local.y() = 0.5 * (owner.size_m.y() - d.size_m.y());
        local.x() = rule.zone[0] <= -1 ? 0.0 : slack * 0.5 * owner.size_m.x();
        if (!rule.z_m) item.z_m = whole_mm(owner.z_m + owner.size_m.z() + 0.3);
        break;
      default:
        return false;
    }
    if (rule.place == Place::kFront && gap < 0) item.under = owner_index;
    item.turn_deg = owner.turn_deg + turn + extra;
    const Vector2d at = from_frame(owner.at_m, owner.turn_deg, local);
    item.at_m = {whole_mm(at.x()), whole_mm(at.y())};
    return true;
  }

  /// Seats around a table: along both long sides, then at its ends.
  void around(const Design& d, std::size_t table_index, int count) {
    const LayoutItem table = layout_.item(table_index);
    const double w = table.size_m.x(), depth = table.size_m.y();
    const double room = d.size_m.x() + 0.12;
    const int per_side = std::max(1, static_cast<int>((w - 0.1) / room));
    struct Seat {
      Vector2d local;
      double turn;
    };
    std::vector<Seat> seats;
    for (int i = 0; i < per_side; ++i) {
      const double x = (i + 0.5 - 0.5 * per_side) * std::min(w / per_side, 1.6 * room);
      seats.push_back({{x, -0.5 * (depth + d.size_m.y())}, 180.0});
      seats.push_back({{x, 0.5 * (depth + d.size_m.y())}, 0.0});
    }
    for (const double side : {-1.0, 1.0})
      seats.push_back({{side * 0.5 * (w + d.size_m.y()), 0.0}, side * -90.0});
    for (const Seat& seat : seats) {
      if (count <= 0) return;
      const double gap = draw(dice_, d.rule->gap_m);
      const double extra = half_degrees(draw(dice_, d.rule->turn_deg));
      LayoutItem item = item_of(d);
      const Vector2d out = seat.local.y() != 0 ? Vector2d(0, seat.local.y() > 0 ? 1 : -1)
                                               : Vector2d(seat.local.x() > 0 ? 1 : -1, 0);
      const Vector2d at = from_frame(table.at_m, table.turn_deg, seat.local + gap * out);
      item.at_m = {whole_mm(at.x()), whole_mm(at.y())};
      item.turn_deg = table.turn_deg + seat.turn + extra;
      if (gap < 0) item.under = table_index;
      if (const auto added = add(item, d)) {
        --count;
        place_parts(*d.rule, *added);
      }
    }
  }

  // ---- many of a kind ------------------------------------------------------------------------

  /// Rows of equal pieces that face one wall: desks in a classroom.
  int rows(const Design& d) {
    const FloorRect& r = layout_.rect();
    double turn = 90.0 * dice_.whole(0, 3);
    for (const LayoutItem& item : layout_.items())  // towards what is written on
      if (item.kind->class_name == "whiteboard") turn = item.turn_deg;
    const bool swapped = std::abs(std::sin(turn * kDegree)) > 0.5;
    const double wide = swapped ? r.y1 - r.y0 : r.x1 - r.x0;
    const double deep = swapped ? r.x1 - r.x0 : r.y1 - r.y0;
    const double aisle = draw(dice_, d.rule->gap_m), way = draw(dice_, d.rule->spacing_m);
    const double margin = 0.75, before = 1.7, behind = 0.3;
    const int columns =
        std::max(1, static_cast<int>((wide - 2 * margin + aisle) / (d.size_m.x() + aisle)));
    const int lines =
        std::max(1, static_cast<int>((deep - before - behind) / (d.size_m.y() + way)));
    const int wanted = draw_count(dice_, d.rule->count);
    int placed = 0;
    for (int j = 0; j < lines && placed < wanted; ++j)
      for (int i = 0; i < columns && placed < wanted; ++i) {
        const Vector2d local((i + 0.5 - 0.5 * columns) * (d.size_m.x() + aisle),
                             0.5 * deep - before - j * (d.size_m.y() + way) - 0.5 * d.size_m.y());
        placed += place_in_room(d, local, turn, turn) ? 1 : 0;
      }
    return placed;
  }

  /// Double rows back to back, a way between them and round their ends: shelves in a shop.
  int aisles(const Design& d) {
    const FloorRect& r = layout_.rect();
    const bool along_y = dice_.chance(0.5);
    const double wide = along_y ? r.y1 - r.y0 : r.x1 - r.x0;  // along a row
    const double deep = along_y ? r.x1 - r.x0 : r.y1 - r.y0;
    const double turn = along_y ? 90.0 : 0.0;
    const double way = draw(dice_, d.rule->spacing_m), w = d.size_m.x(), depth = d.size_m.y();
    const double end = 0.85, pitch = 2 * depth + 0.02 + way;
    const int lines = static_cast<int>((deep - 2 * (depth + way) + way) / pitch);
    const int per_line = static_cast<int>((wide - 2 * end) / (w + 0.01));
    const int wanted = draw_count(dice_, d.rule->count);
    int placed = 0;
    for (int j = 0; j < lines; ++j)
      for (int i = 0; i < per_line && placed < wanted; ++i)
        for (const double side : {-1.0, 1.0}) {
          const Vector2d local((i + 0.5 - 0.5 * per_line) * (w + 0.01),
                               (j + 0.5 - 0.5 * lines) * pitch + side * (0.5 * depth + 0.005));
          placed += place_in_room(d, local, turn, turn + (side < 0 ? 0.0 : 180.0)) ? 1 : 0;
        }
    return placed;
  }

  bool place_in_room(const Design& d, const Vector2d& local, double frame_deg, double turn_deg) {
    const FloorRect& r = layout_.rect();
    const Vector2d middle(0.5 * (r.x0 + r.x1), 0.5 * (r.y0 + r.y1));
    LayoutItem item = item_of(d);
    const Vector2d at = from_frame(middle, frame_deg, local);
    item.at_m = {whole_mm(at.x()), whole_mm(at.y())};
    item.turn_deg = turn_deg + half_degrees(draw(dice_, d.rule->turn_deg));
    const auto added = add(item, d);
    if (added) place_parts(*d.rule, *added);
    return added.has_value();
  }

  /// Curtains at both sides of each window; what is as wide as a window (radiators, blinds) once.
  void at_windows(const Design& common) {
    for (const WallOpening& window : std::vector(layout_.openings())) {
      if (window.door) continue;
      const WallRun& wall = layout_.walls()[static_cast<std::size_t>(window.side)];
      const double middle = 0.5 * (window.from_m + window.to_m);
      Design d = common;
      std::vector<double> places{middle};
      double z = 0;
      if (d.kind->name == "curtain") {
        z = 0.02;
        d.size_m.z() = std::min(window.high_m + 0.14, layout_.height_m() - 0.02) - z;
        const double half = 0.5 * (window.to_m - window.from_m + d.size_m.x()) + 0.02;
        places = {middle - half, middle + half};
      } else if (d.kind->name == "radiator") {
        d.size_m.x() = whole_mm(0.85 * (window.to_m - window.from_m));
        d.size_m.z() = std::min(d.size_m.z(), window.low_m - 0.15);
        if (d.size_m.z() < 0.25) continue;
        z = 0.08;
      } else {  // blinds
        d.size_m.x() = window.to_m - window.from_m;
        d.size_m.z() = (window.high_m - window.low_m) * dice_.number(0.25, 0.9);
        z = window.high_m + 0.05 - d.size_m.z();
      }
      for (int k = 0; k < 3; ++k) d.size_m[k] = whole_mm(d.size_m[k]);
      for (const double along : places) {
        LayoutItem item = item_of(d);
        const Vector2d at =
            wall.place(along, d.size_m.y(), d.kind->mount == Mount::kWall ? 0.002 : 0.02);
        item.at_m = {whole_mm(at.x()), whole_mm(at.y())};
        item.turn_deg = wall.turn_deg();
        item.z_m = whole_mm(z);
        item.covers_window = d.kind->name == "blinds";
        if (const auto added = add(item, d)) place_parts(*d.rule, *added);
      }
    }
  }

  /// On the wall beside each door, on either side.
  void at_doors(const Design& d) {
    constexpr double kFrame_m = 0.1;
    for (const WallOpening& door : std::vector(layout_.openings())) {
      if (!door.door) continue;
      const WallRun& wall = layout_.walls()[static_cast<std::size_t>(door.side)];
      const double gap = kFrame_m + draw(dice_, d.rule->gap_m), half = 0.5 * d.size_m.x();
      const bool before = dice_.chance(0.5);
      for (const bool low : {before, !before}) {
        LayoutItem item = item_of(d);
        const Vector2d at = wall.place(low ? door.from_m - gap - half : door.to_m + gap + half,
                                       d.size_m.y(), 0.002);
        item.at_m = {whole_mm(at.x()), whole_mm(at.y())};
        item.turn_deg = wall.turn_deg();
        item.z_m = d.rule->z_m ? whole_mm(draw(dice_, *d.rule->z_m)) : 0.0;
        if (add(item, d)) break;
      }
    }
  }

  /// Along some wall, wherever it is free: what goes round a room, in pieces between the furniture.
  void along_wall(const Design& common) {
    constexpr double kStep_m = 0.05, kLeast_m = 0.3, kCorner_m = 0.03;
    const WallRun& wall = layout_.walls()[dice_.below(layout_.walls().size())];
    Design d = common;
    const double z = common.rule->z_m ? common.rule->z_m->low : 0.0;
    for (double from = wall.from_m + kCorner_m; from + kLeast_m < wall.to_m;) {
      double to = wall.to_m - kCorner_m;
      bool placed = false;
      for (; !placed && to - from >= kLeast_m; to -= kStep_m) {
        d.size_m.x() = whole_mm(std::min(to - from, common.size_m.x()));
        LayoutItem item = item_of(d);
        const Vector2d at = wall.place(from + 0.5 * d.size_m.x(), d.size_m.y(), 0.002);
        item.at_m = {whole_mm(at.x()), whole_mm(at.y())};
        item.turn_deg = wall.turn_deg();
        item.z_m = whole_mm(z);
        placed = add(item, d).has_value();
      }
      from += placed ? d.size_m.x() + 0.006 : kStep_m;
    }
  }

  void add_extras() {
    std::vector<Design> designs;
    double total = 0;
    for (const ItemRule& rule : grammar_.extras) total += rule.weight;
    for (int tries = 0; !full() && tries < 40 + 12 * target_ && total > 0; ++tries) {
      double at = dice_.number(0, total);
      std::size_t i = 0;
      while (i + 1 < grammar_.extras.size() && at >= grammar_.extras[i].weight)
        at -= grammar_.extras[i++].weight;
      const ItemRule& rule = grammar_.extras[i];
      const Design d = design(rule);
      const int& there = counts_[std::string(d.kind->name)];
      const int count = draw_count(dice_, rule.count);
      for (int k = 0; k < count && !full() && there < rule.most; ++k)
        if (const auto index = place_one(design_of_piece(d, k))) place_parts(rule, *index);
    }
  }

  /// What an L-shaped room has beside its missing corner.
  struct Arm {
    Vector2d middle_m, end_m;
  };
  /// The one west or east of the corner, then the one south or north of it.
  std::array<Arm, 2> arms(const FloorRect& cut) const {
    const FloorRect& room = layout_.rect();
    const double x = 0.5 * (cut.x0 > room.x0 ? room.x0 + cut.x0 : cut.x1 + room.x1),
                 y = 0.5 * (cut.y0 > room.y0 ? room.y0 + cut.y0 : cut.y1 + room.y1);
    return {{{{x, 0.5 * (cut.y0 + cut.y1)}, {x, cut.y0 > room.y0 ? room.y1 : room.y0}},
             {{0.5 * (cut.x0 + cut.x1), y}, {cut.x0 > room.x0 ? room.x1 : room.x0, y}}}};
  }

  /// From beside the missing corner, if there is one, to the middle of that arm.
  Vector2d beside_cut(const Vector2d& at_m) const {
    if (!layout_.cut()) return at_m;
    const FloorRect& cut = *layout_.cut();
    const bool beside_x = at_m.y() > cut.y0 && at_m.y() < cut.y1;
    const bool beside_y = at_m.x() > cut.x0 && at_m.x() < cut.x1;
    if (beside_x == beside_y) return at_m;  // in neither arm, or in the corner itself
    if (beside_x) return {arms(cut)[0].middle_m.x(), at_m.y()};
    return {at_m.x(), arms(cut)[1].middle_m.y()};
  }

  /// Whether a lamp shines on it round no corner.
  bool is_lit(const Vector2d& at_m) const {
    constexpr double kFar_m = 4.0;
    constexpr int kSteps = 50;
    return std::ranges::any_of(layout_.items(), [&](const LayoutItem& item) {
      if (!item.glow) return false;
      const Vector2d way = item.at_m - at_m;
      for (int k = 0; layout_.cut() && k <= kSteps; ++k)
        if (layout_.cut()->contains(at_m + way * k / kSteps)) return false;
      return way.norm() < kFar_m;
    });
  }

  bool add_lamps() {
    const FloorRect& r = layout_.rect();
    const double area = layout_.floor_area_m2();
    const int count = std::max(1, static_cast<int>(std::lround(area / grammar_.area_per_lamp_m2)));
    const double w = r.x1 - r.x0, d = r.y1 - r.y0;
    const int nx = std::max(1, static_cast<int>(std::lround(std::sqrt(count * w / d))));
    const int ny = std::max(1, static_cast<int>(std::lround(static_cast<double>(count) / nx)));
    ItemRule rule;
    rule.kinds = {grammar_.lamp};
    rule.place = Place::kCeiling;
    const Design design_of_lamps = design(rule);
    const double power = draw(dice_, grammar_.lamp_power), warm = draw(dice_, grammar_.warmth);
    const Vector3d color(power, power * (1.0 - 0.14 * warm), power * (1.0 - 0.42 * warm));
    const auto hang = [&](const Vector2d& at) {
      LayoutItem item = item_of(design_of_lamps);
      item.at_m = {whole_mm(at.x()), whole_mm(at.y())};
      item.z_m = whole_mm(layout_.height_m() - item.size_m.z());
      item.glow = color;
      return add(item, design_of_lamps).has_value();
    };
    int placed = 0;
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const Vector2d at(r.x0 + (i + 0.5) * w / nx, r.y0 + (j + 0.5) * d / ny);
        placed += hang(at) || hang(beside_cut(at)) ? 1 : 0;
      }
    if (placed == 0) return false;
    if (layout_.cut())
      for (const Arm& arm : arms(*layout_.cut()))
        if (!is_lit(arm.end_m)) hang(arm.middle_m);
    dusk_ = dice_.chance(0.15);
    sun_turn_ = dice_.number(0, 360);
    sun_power_ = dice_.number(8, 17);
    sky_power_ = dice_.number(4, 10);
    return true;
  }

  // ---- as text -------------------------------------------------------------------------------

  std::string text(const std::string& name) const {
    const FloorRect& r = layout_.rect();
    std::string out = fmt::format(
        "# Made by modelhouse scene make. docs/formats.md says what the keys mean.\n"
        "name: {}\nextent_m: [0, 0, {:.3f}, {:.3f}]\nheight_m: {:.3f}\n"
        "wall_thickness_m: 0.12\n\nmaterials:\n",
        name, r.x1, r.y1, layout_.height_m());
    const std::set<std::string> used = used_materials();
    for (const auto& [key, value] : materials_)
      if (used.contains(key)) out += fmt::format("  {}: {}\n", key, value);
    out +=
        fmt::format("\nrooms:\n  - name: room\n    rect_m: [0, 0, {:.3f}, {:.3f}]\n", r.x1, r.y1);
    if (const auto& c = layout_.cut())
      out += fmt::format("    cut: {{corner: {}_{}, size_m: [{:.3f}, {:.3f}]}}\n",
                         c->y0 <= 0 ? "south" : "north", c->x0 <= 0 ? "west" : "east",
                         c->x1 - c->x0, c->y1 - c->y0);
    out += fmt::format("    floor: {}\n    ceiling: {}\n    walls: {{all: {}", floor_, ceiling_,
                       wall_);
    if (!accent_.empty()) out += fmt::format(", {}: {}", side_name(accent_side_), accent_);
    out += "}\n    items:\n";
    for (const LayoutItem& item : layout_.items()) out += line(item);
    out += "\n" + openings_text(true) + openings_text(false);
    out += fmt::format(
        "\ntrim: {}\nwindow_frame: {}\n"
        "garden: {{material: {}, distance_m: 11.0, height_m: 7.0, glow: {}}}\n",
        trim_, frame_, garden_, dusk_ ? 0.012 : 0.03);
    // At dusk the sun is down and the sky gives less, but windows are not black.
    const double s = dusk_ ? 0.2 : 1.0, a = sun_turn_ * kDegree;
    out += "\nlights:\n";
    if (!dusk_)
      out += fmt::format(
          "  sun: {{direction: [{:.3f}, {:.3f}, -0.7], color: [{:.3f}, {:.3f}, {:.3f}]}}\n",
          0.6 * std::cos(a), 0.6 * std::sin(a), sun_power_, 0.94 * sun_power_, 0.82 * sun_power_);
    out += fmt::format("  sky: {{color: [{:.3f}, {:.3f}, {:.3f}]}}\n", s * 0.86 * sky_power_,
                       s * 0.97 * sky_power_, s * 1.15 * sky_power_);
    return out;
  }

  std::set<std::string> used_materials() const {
    std::set<std::string> used{floor_, wall_, ceiling_, accent_, trim_, frame_, garden_};
    for (const LayoutItem& item : layout_.items())
      for (const auto& [role, material] : item.materials) used.insert(material);
    return used;
  }

  std::string line(const LayoutItem& item) const {
    std::string out = fmt::format("      - {{name: {}, kind: {}, ", item.name, item.kind->name);
    const auto turned = [](double deg) { return std::remainder(deg, 360.0); };
    if (item.on) {
      out +=
          fmt::format("on: {}, at: [{:.3f}, {:.3f}], turn_deg: {:.1f}", layout_.item(*item.on).name,
                      item.on_at_m.x(), item.on_at_m.y(), turned(item.on_turn_deg));
      if (item.on_board) out += fmt::format(", z_m: {:.3f}", item.z_m - layout_.item(*item.on).z_m);
    } else {
      out += fmt::format("at: [{:.3f}, {:.3f}], turn_deg: {:.1f}", item.at_m.x(), item.at_m.y(),
                         turned(item.turn_deg));
      if (item.z_m > 0 && item.kind->mount != Mount::kCeiling)
        out += fmt::format(", z_m: {:.3f}", item.z_m);
      if (item.under) out += fmt::format(", under: {}", layout_.item(*item.under).name);
    }
    out += fmt::format(", size_m: [{:.3f}, {:.3f}, {:.3f}]", item.size_m.x(), item.size_m.y(),
                       item.size_m.z());
    if (item.glow)
      out += fmt::format(", glow: [{:.3f}, {:.3f}, {:.3f}]", item.glow->x(), item.glow->y(),
                         item.glow->z());
    if (!item.materials.empty()) {
      out += ", materials: {";
      std::string_view comma = "";
      for (const auto& [role, material] : item.materials) {
        out += fmt::format("{}{}: {}", comma, role, material);
        comma = ", ";
      }
      out += "}";
    }
    return out + "}\n";
  }

  std::string openings_text(bool doors) const {
    std::string out;
    for (const WallOpening& o : layout_.openings()) {
      if (o.door != doors) continue;
      if (doors)
        out += fmt::format(
            "  - {{name: {}, rooms: [room], side: {}, span_m: [{:.3f}, {:.3f}], height_m: {:.3f}, "
            "closed: true}}\n",
            o.name, side_name(o.side), o.from_m, o.to_m, o.high_m);
      else
        out += fmt::format(
            "  - {{name: {}, room: room, side: {}, span_m: [{:.3f}, {:.3f}], sill_m: {:.3f}, "
            "head_m: {:.3f}, panes: {}}}\n",
            o.name, side_name(o.side), o.from_m, o.to_m, o.low_m, o.high_m,
            std::max(1, static_cast<int>((o.to_m - o.from_m) / 0.75)));
    }
    if (out.empty()) return out;
    return (doors ? "doorways:\n" : "windows:\n") + out;
  }

  const RoomGrammar& grammar_;
  Dice dice_;
  int group_;
  Layout layout_;
  int target_ = 0;
  bool aimed_ = false;
  bool fitting_ = false;  // what is placed now are fittings
  std::vector<std::pair<std::string, std::string>> materials_;
  std::map<std::string, std::vector<Base>> bases_;
  std::map<std::string, int> counts_;
  std::string floor_, wall_, ceiling_, accent_, trim_, frame_, garden_;
  Side accent_side_ = Side::kSouth;
  bool dusk_ = false;
  double sun_turn_ = 0, sun_power_ = 0, sky_power_ = 0;
};

int draw_group(Dice& dice, const std::array<double, 4>& weights) {
  double at = dice.number(0, weights[0] + weights[1] + weights[2] + weights[3]);
  for (int g = 0; g < 3; ++g) {
    if (at < weights[static_cast<std::size_t>(g)]) return g;
    at -= weights[static_cast<std::size_t>(g)];
  }
  return 3;
}

}  // namespace

GeneratedReference parse_generated(std::string_view source) {
  const std::string text(source);
  const std::size_t first = source.find(':'), last = source.rfind(':');
  GeneratedReference reference;
  const bool shaped = source.starts_with(kGeneratedPrefix) && last > first;
  if (shaped) {
    reference.category = source.substr(first + 1, last - first - 1);
    const std::string_view number = source.substr(last + 1);
    const auto [end, error] =
        std::from_chars(number.data(), number.data() + number.size(), reference.seed);
    if (error == std::errc() && end == number.data() + number.size() && !number.empty()) {
      category_by_name(reference.category);
      return reference;
    }
  }
  throw InputError(
      fmt::format("'{}' names no generated environment: write generated:CATEGORY:SEED, "
                  "for example generated:bathroom:3",
                  text));
}

std::string to_string(const GeneratedReference& reference) {
  return fmt::format("generated:{}:{}", reference.category, reference.seed);
}

GeneratedPlan generate_plan(const GeneratedReference& reference) {
  const Category& category = category_by_name(reference.category);
  const RandomStream stream = RandomStream(name_key(category.name)).fork(reference.seed);
  const RoomGrammar& room = category.rooms[reference.seed % category.rooms.size()];
  Dice chooser(stream.fork(0));
  const int group = draw_group(chooser, room.density);
  for (std::uint64_t draft = 1; draft <= kDrafts; ++draft) {
    Maker maker(room, Dice(stream.fork(draft)), group);
    if (maker.furnish()) return maker.plan(fmt::format("{}-{}", category.name, reference.seed));
  }
  throw MachineError(fmt::format("{}: no room of {} drafts holds what a {} of density {} needs",
                                 to_string(reference), kDrafts, room.name,
                                 density_group_name(group)));
}

std::string with_detail(const GeneratedPlan& plan) {
  const auto fine = [&plan](double detail) {
    return plan.yaml + fmt::format("detail: {:.3f}\n", detail);
  };
  double detail = 1.0;
  for (int round = 0; round < 4; ++round) {
    const auto count = static_cast<double>(count_triangles(fine(detail), plan.name));
    const double wanted = std::clamp(count, static_cast<double>(kLeastTriangles),
                                     static_cast<double>(kMostTriangles));
    if (wanted == count) break;
    // Round shapes do not grow with it: aim a little beyond.
    detail = std::clamp(detail * std::pow(wanted / count, 0.65), 0.5, 6.0);
  }
  return fine(detail);
}

Scene generate_scene(const GeneratedReference& reference) {
  return build_house(with_detail(generate_plan(reference)), to_string(reference));
}

int density_group(double objects_per_10_m2) {
  return objects_per_10_m2 < 4 ? 0 : objects_per_10_m2 < 8 ? 1 : objects_per_10_m2 < 16 ? 2 : 3;
}

std::string_view density_group_name(int group) {
  constexpr std::array<std::string_view, kDensityGroups> kNames = {"0-4", "4-8", "8-16", "16+"};
  return kNames.at(static_cast<std::size_t>(group));
}

}  // namespace mh
