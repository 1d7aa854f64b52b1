// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "slam/io/fields.hpp"
#include "slam/io/setting.hpp"
#include "slam/io/words.hpp"
#include "slam/io/yaml.hpp"

namespace mh {

/// How the doses of a dial are spaced: kLog for factors and shares of light.
enum class DoseScale { kLinear, kLog };
constexpr Names<DoseScale, 2> words(DoseScale) {
  return {{{"linear", DoseScale::kLinear}, {"log", DoseScale::kLog}}};
}

/// A dial of the level that a stress test turns until a system breaks.
struct StressDial {
  std::string dial;  ///< full name: "lens_blur.sigma_px"
  std::string name;  ///< what people call it: "defocus"
  std::string unit;  ///< of what is shown: "px"
  double from = 0;   ///< the dose that is no fault
  double to = 1;     ///< the strongest dose
  DoseScale scale = DoseScale::kLinear;
  double times = 1;             ///< a dose is shown multiplied by this, plus `plus`
  double plus = 0;              ///< 180 degrees a second: what a dose of 1 is
  std::optional<double> usual;  ///< published dose of usual equipment
  std::string source;           ///< of that figure
};

template <MaybeConst<StressDial> D, class Visit>
void fields(D& d, Visit& v) {
  auto& [dial, name, unit, from, to, scale, times, plus, usual, source] = d;
  constexpr SettingRange kAny{-1e9, 1e9};
  (void)dial;  // the key under which the others are listed
  v("name", name, {}, "what people call it; default: the dial");
  v("unit", unit, {}, "unit of what is shown");
  v("from", from, kAny, "the dose that is no fault");
  v("to", to, setting::required(kAny), "the strongest dose");
  v("scale", scale, {}, "`log` for factors: doses are spaced by ratios");
  v("times", times, kAny, "a dose is shown multiplied by this ...");
  v("plus", plus, kAny, "... plus this");
  v("usual", usual, kAny, "dose of usual equipment, as published");
  v("source", source, {}, "of that figure");
}

/// What a system is judged by while it is stressed: frames of the mapped path that it placed right,
/// or correct answers to held-out queries. The latter are judged by the map around them, so that
/// they hardly see a wrong scale.
enum class StressMeasure { kPlaced, kCorrect };
constexpr Names<StressMeasure, 2> words(StressMeasure) {
  return {{{"placed", StressMeasure::kPlaced}, {"correct", StressMeasure::kCorrect}}};
}

/// The section `stress` of a suite: how much can each system stand?
struct StressSpec {
  StressMeasure measure = StressMeasure::kPlaced;
  double near_m = 0.05;
  double bar = 0.5;
  int steps = 4;
  std::vector<StressDial> dials;
};

template <MaybeConst<StressSpec> S, class Visit>
void fields(S& s, Visit& v) {
  auto& [measure, near_m, bar, steps, dials] = s;
  (void)dials;
  v("measure", measure, {},
    "share of the frames with a pose near the truth, or of held-out queries answered correctly");
  v("near_m", near_m, setting::above(0, 100),
    "`placed`: a frame is placed right within this distance, after alignment of the whole path");
  v("bar", bar, setting::above(0, 1),
    "a system is broken where its share is below this part of its share without the fault");
  v("steps", steps, {1, 12}, "bisections of a dial's range");
}

/// Reads the section. @throws InputError naming file, line, field and value.
StressSpec read_stress(YamlReader node);

/// The dose at a share of a dial's range: `from` at 0, `to` at 1.
double exact_dose_at(const StressDial& dial, double share);
/// The same rounded, as it is run: to whole numbers for whole dials, to four digits for others.
double dose_at(const StressDial& dial, double share);
/// The inverse of dose_at(), without the rounding.
double share_of(const StressDial& dial, double dose);
/// The factor between no fault and the strongest dose, at least 1. @pre the scale is kLog
double factor_of(const StressDial& dial);
/// A dose as people say it: "180 deg/s"
double shown_dose(const StressDial& dial, double dose);

}  // namespace mh
