// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "scenes/materials/canvas.hpp"
#include "scenes/materials/painters.hpp"

namespace mh {
namespace {

constexpr std::array<std::string_view, 64> kWords = {
    "THE",    "RIVER",   "HOUSE",  "WINTER",  "GARDEN", "OF",    "STONE",   "LIGHT",
    "NORTH",  "HISTORY", "AND",    "SALT",    "MAPS",   "COAST", "LETTERS", "ATLAS",
    "SILENT", "BREAD",   "OCEAN",  "TALES",   "IRON",   "MUSIC", "FOREST",  "YEARS",
    "SHORT",  "GUIDE",   "TO",     "BIRDS",   "CITY",   "NIGHT", "WIND",    "PAPER",
    "ISLAND", "BLUE",    "ROAD",   "HOME",    "FIELD",  "CLOCK", "SUMMER",  "TRAINS",
    "LOST",   "GLASS",   "DREAMS", "KITCHEN", "WOLF",   "SNOW",  "DIARY",   "MOON",
    "SEVEN",  "RED",     "BRIDGE", "LAST",    "ART",    "SHIPS", "QUIET",   "WORLD",
    "OLD",    "PHYSICS", "DOORS",  "APPLE",   "SPRING", "WALKS", "FIRE",    "VOICES"};

/// Sequential draws from one stream: each number is used once.
class Dice {
 public:
  explicit Dice(RandomStream random) : random_(random) {}
  float uniform(float low = 0.0F, float high = 1.0F) {
    return static_cast<float>(random_.uniform(next_++, low, high));
  }
  int below(int count) {
    return static_cast<int>(random_.below(next_++, static_cast<std::uint64_t>(count)));
  }
  std::string words(int count) {
    std::string text;
    for (int i = 0; i < count; ++i) {
      if (i > 0) text += ' ';
      text += kWords[static_cast<std::size_t>(below(kWords.size()))];
    }
    return text;
  }

 private:
  RandomStream random_;
  std::uint64_t next_ = 0;
};

/// Color of a hue in [0, 1) at a saturation and brightness in [0, 1].
Tint hsv(float hue, float saturation, float value) {
  const auto channel = [&](float n) {
    const float k = std::fmod(n + 6.0F * hue, 6.0F);
    return 255.0F * value * (1.0F - saturation * std::clamp(std::min(k, 4.0F - k), 0.0F, 1.0F));
  };
  return {channel(5.0F), channel(3.0F), channel(1.0F)};
}

/// A random color with value and saturation within these bounds.
Tint random_tint(Dice& dice, float s_low, float s_high, float v_low, float v_high) {
  const float hue = dice.uniform(), saturation = dice.uniform(s_low, s_high);
  return hsv(hue, saturation, dice.uniform(v_low, v_high));
}

Tint ink_for(Tint paper, Dice& dice) {
  const float brightness = 0.3F * paper.r + 0.6F * paper.g + 0.1F * paper.b;
  if (brightness > 130.0F) return random_tint(dice, 0.5F, 0.5F, 0.08F, 0.25F);
  return dice.below(3) == 0 ? Tint(226, 190, 96) : Tint(238, 234, 222);
}

Tint cloth_for(const PaintJob& job, Dice& dice) {
  const int style = dice.below(10);
  if (style == 0) return Tint(234, 229, 214) * dice.uniform(0.88F, 1.0F);
  if (style == 1) return Tint(38, 36, 40) * dice.uniform(0.7F, 1.5F);
  if (style <= 3) return job.tone * dice.uniform(0.6F, 1.15F);
  return random_tint(dice, 0.2F, 0.68F, 0.22F, 0.78F);
}

/// Grain over a whole image, so that flat prints are not mathematically flat.
void add_grain(Image& image, const PaintJob& job, float strength) {
  const Field grain = white_noise(image.width(), image.height(), job.random.fork(99));
  const Field broad = fbm(image.width(), image.height(), {2, 2, 3, 0.5F}, job.random.fork(98));
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      image(x, y) = to_rgb8(Tint(image(x, y)) *
                            (1.0F + strength * (0.012F * grain(x, y) + 0.05F * broad(x, y))));
}

struct PrintBox {
  float x, y, width, height;
};

/// Lines of small print filling a box, ragged at the right.
void small_print(Canvas& canvas, Dice& dice, const PrintBox& box, float letter, Tint ink) {
  const auto& [x, y, width, height] = box;
  for (float line = y + letter; line <= y + height; line += 1.9F * letter) {
    std::string text = dice.words(1);
    while (true) {
      const std::string longer = text + ' ' + dice.words(1);
      if (Canvas::text_width(longer, letter) > width) break;
      text = longer;
    }
    if (dice.below(6) == 0) text.resize(text.size() / 2);
    for (std::size_t i = 1; i < text.size(); ++i)
      if (text[i] != ' ') text[i] = static_cast<char>(text[i] - 'A' + 'a');
    canvas.text(text, {x, line}, {letter, 1.0F}, ink);
  }
}

/// An emblem of a few simple shapes.
void emblem(Canvas& canvas, Dice& dice, const Eigen::Vector2f& at, float radius, Tint a, Tint b) {
  const float x = at.x(), y = at.y();
  switch (dice.below(4)) {
    case 0:
      canvas.ellipse(x, y, radius, radius, 0.0F, a);
      canvas.ellipse(x + 0.3F * radius, y - 0.2F * radius, 0.75F * radius, 0.75F * radius, 0.0F, b);
      break;
    case 1:
      canvas.polygon({{x - radius, y + radius}, {x, y - radius}, {x + radius, y + radius}}, a);
      canvas.polygon({{x - 0.2F * radius, y + radius},
                      {x + 0.5F * radius, y},
                      {x + 1.2F * radius, y + radius}},
                     b);
      break;
    case 2:
      for (int i = 5; i > 0; --i) {
        const float r = radius * static_cast<float>(i) / 5.0F;
        canvas.ellipse(x, y, r, r, 0.0F, i % 2 == 0 ? b : a);
      }
      break;
    default:
      for (int i = 0; i < 7; ++i) {
        const float turn = static_cast<float>(i) * 2.0F * std::numbers::pi_v<float> / 7.0F;
        canvas.ellipse(x + 0.6F * radius * std::cos(turn), y + 0.6F * radius * std::sin(turn),
                       0.42F * radius, 0.2F * radius, turn, i % 2 == 0 ? a : b);
      }
      canvas.ellipse(x, y, 0.25F * radius, 0.25F * radius, 0.0F, b);
  }
}

void slash(Canvas& canvas, Dice& dice, const Eigen::Vector2f& at, float reach, float thickness,
           Tint tint) {
  const float dx = dice.uniform(-2, 2) * reach, dy = dice.uniform(-2, 2) * reach;
  canvas.line(at.x(), at.y(), at.x() + dx, at.y() + dy, thickness, tint);
}

/// The spine of one book: `width` wide from x on, its top edge at y.
void spine(Image& image, const PaintJob& job, Dice& dice, int x, int y, int width) {
  const int height = image.height() - y;
  Image book(width, height);
  const Tint cloth = cloth_for(job, dice);
  const Tint ink = ink_for(cloth, dice);
  const auto w = static_cast<float>(width), h = static_cast<float>(height);
  Canvas canvas(book);
  canvas.rectangle(0, 0, w, h, cloth);
  const int style = dice.below(5);
  if (style == 0) {  // a label in a different color
    const Tint label = cloth_for(job, dice);
    canvas.rectangle(0, 0.12F * h, w, 0.22F * h, label);
    canvas.rectangle(0, 0.80F * h, w, 0.03F * h, label);
  } else if (style == 1) {  // raised bands
    for (const float band : {0.08F, 0.26F, 0.70F, 0.86F}) {
      canvas.rectangle(0, band * h, w, std::max(1.0F, 0.012F * h), ink);
      canvas.rectangle(0, (band + 0.022F) * h, w, 1.0F, ink);
    }
  } else if (style == 2) {
    canvas.rectangle(0, dice.uniform(0.6F, 0.8F) * h, w, h, blend(cloth, ink, 0.55F));
  }
  const float letter = std::clamp(0.42F * w, 4.0F, 12.0F);
  std::string title = dice.words(2 + dice.below(2));
  while (title.find(' ') != std::string::npos && Canvas::text_width(title, letter) > 0.62F * h)
    title.resize(title.rfind(' '));
  const float length = Canvas::text_width(title, letter);
  canvas.text(title, {0.5F * (w + letter), 0.12F * h + length},
              {letter, letter > 7.0F ? 2.0F : 1.0F, true}, ink);
  if (width > 10) emblem(canvas, dice, {0.5F * w, 0.92F * h}, 0.22F * w, ink, cloth);
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {  // rounded back: dark at the gaps between the books
      const float t = 2.0F * (static_cast<float>(i) + 0.5F) / w - 1.0F;
      const float top = j < 2 ? 0.8F : 1.0F;
      const float shade = i == 0 || i == width - 1 ? 0.35F : 1.04F - 0.35F * t * t * t * t;
      image(x + i, y + j) = to_rgb8(Tint(book(i, j)) * (shade * top));
    }
}

}  // namespace

Image paint_book_spines(const PaintJob& job) {
  Image image(job.width, job.height, to_rgb8(Tint(26, 22, 20)));
  Dice dice(job.random);
  int x = 0;
  while (x < job.width) {
    // Now and then there is a series of books of the same height and width.
    const float size = dice.uniform(0.72F, 0.97F);
    const int width = job.texels(dice.uniform(0.014F, 0.046F));
    const int copies = dice.below(7) == 0 ? 3 : 1;
    for (int i = 0; i < copies && x < job.width; ++i) {
      const int thick = std::min(std::max(width, 4), job.width - x);
      const int top = static_cast<int>((1.0F - size) * static_cast<float>(job.height));
      spine(image, job, dice, x, top, thick);
      x += thick;
    }
  }
  add_grain(image, job, 1.0F);
  return image;
}

Image paint_book_cover(const PaintJob& job) {
  Image image(job.width, job.height, to_rgb8(job.tone));
  Dice dice(job.random);
  Canvas canvas(image);
  const auto w = static_cast<float>(job.width), h = static_cast<float>(job.height);
  const Tint ink = ink_for(job.tone, dice);
  const Tint second = hsv(dice.uniform(), 0.6F, 0.75F);
  canvas.frame(0.05F * w, 0.04F * h, 0.9F * w, 0.92F * h, std::max(1.0F, 0.012F * w), ink);
  const float letter = 0.085F * w;
  canvas.text(dice.words(1), {0.12F * w, 0.17F * h}, {letter, 0.16F * letter}, ink);
  canvas.text(dice.words(1), {0.12F * w, 0.17F * h + 1.6F * letter}, {letter, 0.16F * letter}, ink);
  emblem(canvas, dice, {0.5F * w, 0.58F * h}, 0.26F * std::min(w, h), second, ink);
  canvas.text(dice.words(2), {0.12F * w, 0.91F * h}, {0.45F * letter, 1.0F}, ink);
  add_grain(image, job, 1.0F);
  return image;
}

Image paint_poster(const PaintJob& job) {
  Dice dice(job.random);
  const Tint second = random_tint(dice, 0.4F, 0.8F, 0.5F, 0.95F);
  const Tint third = random_tint(dice, 0.7F, 0.7F, 0.2F, 0.6F);
  const Tint below = blend(job.tone, second, 0.35F);
  Image image = paint(job, [&](int, int y) {
    return blend(job.tone, below, static_cast<float>(y) / static_cast<float>(job.height));
  });
  Canvas canvas(image);
  const auto w = static_cast<float>(job.width), h = static_cast<float>(job.height);
  const float small = std::min(w, h);
  for (int i = 0; i < 22; ++i) {
    const Tint tint = i % 3 == 0   ? third
                      : i % 3 == 1 ? second
                                   : blend(second, Tint(255, 250, 235), 0.6F);
    const float x = dice.uniform(0.05F, 0.95F) * w, y = dice.uniform(0.18F, 0.72F) * h;
    const float r = dice.uniform(0.05F, 0.2F) * small;
    switch (dice.below(4)) {
      case 0:
        emblem(canvas, dice, {x, y}, r, tint, job.tone);
        break;
      case 1:
        slash(canvas, dice, {x, y}, r, 0.02F * small, tint);
        break;
      case 2:
        for (int k = 0; k < 6; ++k)
          canvas.rectangle(x + 0.3F * static_cast<float>(k) * r, y, 0.16F * r, 1.6F * r, tint);
        break;
      default:
        canvas.ellipse(x, y, r, 0.6F * r, dice.uniform(0, 3), tint);
    }
  }
  const Tint ink = ink_for(job.tone, dice);
  const std::string title = dice.words(2);
  float letter = 0.11F * w;
  letter *= std::min(1.0F, 0.84F * w / Canvas::text_width(title, letter));
  canvas.text(title, {0.08F * w, 0.05F * h + letter}, {letter, 0.18F * letter}, ink);
  canvas.text(dice.words(3), {0.08F * w, 0.05F * h + 1.9F * letter}, {0.4F * letter, 1.0F}, ink);
  canvas.rectangle(0, 0.78F * h, w, 0.22F * h, blend(job.tone, Tint(250, 247, 238), 0.8F));
  small_print(canvas, dice, {0.08F * w, 0.81F * h, 0.5F * w, 0.15F * h}, std::max(4.0F, 0.012F * h),
              Tint(40, 38, 44));
  emblem(canvas, dice, {0.82F * w, 0.89F * h}, 0.07F * small, third, second);
  add_grain(image, job, 0.7F);
  return image;
}

Image paint_paper(const PaintJob& job) {
  Image image(job.width, job.height, to_rgb8(job.tone));
  Dice dice(job.random);
  Canvas canvas(image);
  const auto w = static_cast<float>(job.width), h = static_cast<float>(job.height);
  const Tint ink = blend(Tint(35, 34, 40), job.tone, 0.15F);
  const float letter = std::max(4.0F, 0.014F * h);
  canvas.text(dice.words(3), {0.1F * w, 0.09F * h}, {1.8F * letter, 2.0F}, ink);
  const float split = dice.uniform(0.35F, 0.6F);
  small_print(canvas, dice, {0.1F * w, 0.14F * h, 0.8F * w, (split - 0.16F) * h}, letter, ink);
  canvas.rectangle(0.1F * w, split * h, 0.36F * w, 0.2F * h, hsv(dice.uniform(), 0.3F, 0.75F));
  emblem(canvas, dice, {0.28F * w, (split + 0.1F) * h}, 0.07F * w, hsv(dice.uniform(), 0.6F, 0.5F),
         ink);
  small_print(canvas, dice, {0.5F * w, split * h, 0.4F * w, 0.2F * h}, letter, ink);
  small_print(canvas, dice, {0.1F * w, (split + 0.24F) * h, 0.8F * w, (0.68F - split) * h}, letter,
              ink);
  add_grain(image, job, 0.6F);
  return image;
}

Image paint_screen(const PaintJob& job) {
  // Half of the screens show a desktop with windows, the others a broadcast with a ticker.
  Dice dice(job.random);
  const auto w = static_cast<float>(job.width), h = static_cast<float>(job.height);
  const Tint sky = hsv(dice.uniform(0.5F, 0.7F), 0.5F, 0.85F);
  const Field hills = fbm(job.width, 8, {3, 1, 6, 0.5F}, job.random.fork(1));
  Image image = paint(job, [&](int x, int y) {
    const float v = static_cast<float>(y) / h;
    Tint tint = blend(sky, Tint(250, 225, 190), v * 1.2F);
    for (int ridge = 0; ridge < 3; ++ridge) {
      const float crest = 0.40F + 0.16F * static_cast<float>(ridge) + 0.22F * hills(x, 2 * ridge);
      if (v > crest)
        tint = blend(job.tone, Tint(25, 40, 45), 0.15F + 0.3F * static_cast<float>(ridge));
    }
    return tint;
  });
  Canvas canvas(image);
  const float letter = std::max(4.0F, 0.022F * h);
  if (dice.below(2) == 0) {
    canvas.rectangle(0, 0.94F * h, w, 0.06F * h, Tint(32, 34, 40));
    for (int i = 0; i < 8; ++i)
      canvas.rectangle((0.02F + 0.035F * static_cast<float>(i)) * w, 0.952F * h, 0.022F * w,
                       0.036F * h, hsv(dice.uniform(), 0.7F, 0.9F));
    for (int i = 0; i < 2; ++i) {
      const float x = (0.06F + 0.42F * static_cast<float>(i)) * w,
                  y = (0.1F + dice.uniform(0, 0.12F)) * h;
      const float width = 0.44F * w, height = 0.6F * h;
      canvas.rectangle(x, y, width, height, i == 0 ? Tint(246, 247, 249) : Tint(36, 39, 48));
      canvas.rectangle(x, y, width, 0.05F * h, i == 0 ? Tint(205, 210, 220) : Tint(62, 66, 80));
      canvas.text(dice.words(2), {x + letter, y + 0.037F * h}, {0.8F * letter, 1.0F},
                  i == 0 ? Tint(40, 40, 50) : Tint(220, 220, 225));
      small_print(canvas, dice, {x + letter, y + 0.08F * h, width - 2.5F * letter, 0.46F * h},
                  letter, i == 0 ? Tint(60, 62, 70) : Tint(150, 210, 160));
    }
  } else {
    canvas.ellipse(0.72F * w, 0.24F * h, 0.05F * w, 0.05F * w, 0.0F, Tint(255, 246, 214));
    canvas.rectangle(0, 0.82F * h, w, 0.1F * h, Tint(170, 28, 36));
    canvas.text(dice.words(4), {0.03F * w, 0.892F * h}, {2.0F * letter, 3.0F}, Tint(250, 250, 250));
    canvas.rectangle(0, 0.92F * h, w, 0.08F * h, Tint(236, 238, 242));
    canvas.text(dice.words(9), {0.03F * w, 0.97F * h}, {1.2F * letter, 1.0F}, Tint(30, 32, 40));
    canvas.rectangle(0.86F * w, 0.05F * h, 0.1F * w, 0.07F * h, Tint(22, 60, 140));
    canvas.text(dice.words(1).substr(0, 3), {0.875F * w, 0.1F * h}, {1.5F * letter, 2.0F},
                Tint(250, 250, 250));
  }
  return image;
}

Image paint_whiteboard(const PaintJob& job) {
  const Field broad = fbm(job.width, job.height, {3, 2, 3, 0.5F}, job.random.fork(0));
  Image image = paint(job, [&](int x, int y) {
    return job.tone * (1.0F + 0.012F * broad(x, y));  // not wiped quite clean
  });
  Canvas canvas(image);
  const RandomStream random = job.random.fork(1);
  constexpr std::array<Tint, 3> kPens = {Tint{40, 60, 150}, Tint{30, 30, 34}, Tint{176, 40, 40}};
  const auto w = static_cast<float>(job.width), h = static_cast<float>(job.height);
  const float pen = static_cast<float>(job.texels(0.006));
  // Blocks of writing and a sketch or two; many boards are empty.
  const int blocks = static_cast<int>(job.variation * 6.0F * static_cast<float>(random.uniform(0)));
  for (int b = 0; b < blocks; ++b) {
    const RandomStream r = random.fork(static_cast<std::uint64_t>(10 + b));
    const Tint tint = kPens[r.below(0, kPens.size())];
    const auto x0 = static_cast<float>(r.uniform(1, 0.04, 0.66)) * w;
    const auto y0 = static_cast<float>(r.uniform(2, 0.08, 0.6)) * h;
    const float line = static_cast<float>(job.texels(0.07));
    if (r.uniform(3) < 0.3) {
      canvas.frame(x0, y0, 0.18F * w, 0.22F * h, pen, tint);
      canvas.line(x0 + 0.18F * w, y0 + 0.1F * h, x0 + 0.28F * w, y0 + 0.16F * h, pen, tint);
      canvas.ellipse(x0 + 0.30F * w, y0 + 0.18F * h, 0.03F * w, 0.05F * h, 0.0F, tint);
      continue;
    }
    for (int i = 0; i < 2 + static_cast<int>(r.below(4, 5)); ++i) {
      const RandomStream q = r.fork(static_cast<std::uint64_t>(i));
      float x = x0;
      const float y = y0 + line * static_cast<float>(i),
                  end = x0 + w * static_cast<float>(q.uniform(0, 0.1, 0.3));
      float low = y;
      for (std::uint64_t k = 1; x < end; k += 2) {  // a zigzag like handwriting
        const float nx = x + 0.28F * line * static_cast<float>(q.uniform(k, 0.4, 1.2));
        const float ny = y - 0.55F * line * static_cast<float>(q.uniform(k + 1, -0.2, 1.0));
        if (q.uniform(k + 1000) > 0.15) canvas.line(x, low, nx, ny, pen, tint);
        x = nx;
        low = ny;
      }
    }
  }
  return image;
}

}  // namespace mh
