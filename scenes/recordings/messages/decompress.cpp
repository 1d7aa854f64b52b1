// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/messages/decompress.hpp"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "slam/io/error.hpp"

namespace mh {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 20;

[[noreturn]] void damaged(const char* compression) {
  throw InputError(fmt::format("is damaged: its {} data cannot be decompressed", compression));
}

/// Makes room for the next bytes of a result that should have at most `size` bytes, but allows one
/// byte more, so that a longer result is noticed.
std::size_t make_room(std::string& out, std::size_t used, std::uint64_t size) {
  if (used == out.size())
    out.resize(std::min<std::size_t>(size + 1, std::max(kPiece, 2 * out.size())));
  return out.size() - used;
}

std::string from_lz4(std::string_view in, std::uint64_t size) {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)))
    throw MachineError("out of memory");
  const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> owner(
      context, LZ4F_freeDecompressionContext);
  std::string out;
  std::size_t used = 0, hint = 1;
  while (hint != 0 && used <= size) {
    std::size_t room = make_room(out, used, size), taken = in.size();
    hint = LZ4F_decompress(context, out.data() + used, &room, in.data(), &taken, nullptr);
    if (LZ4F_isError(hint) || (room == 0 && taken == 0)) damaged("lz4");
    used += room;
    in.remove_prefix(taken);
  }
  out.resize(used);
  return out;
}

std::string from_zstd(std::string_view in, std::uint64_t size) {
  const std::unique_ptr<ZSTD_DCtx, std::size_t (*)(ZSTD_DCtx*)> context(ZSTD_createDCtx(),
                                                                        ZSTD_freeDCtx);
  if (context == nullptr) throw MachineError("out of memory");
  ZSTD_inBuffer from{in.data(), in.size(), 0};
  std::string out;
  std::size_t used = 0;
  for (std::size_t hint = 1; hint != 0 && used <= size;) {
    const std::size_t room = make_room(out, used, size);
    ZSTD_outBuffer to{out.data() + used, room, 0};
    const std::size_t taken = from.pos;
    hint = ZSTD_decompressStream(context.get(), &to, &from);
    if (ZSTD_isError(hint) || (to.pos == 0 && from.pos == taken)) damaged("zstd");
    used += to.pos;
  }
  out.resize(used);
  return out;
}

std::string from_bz2(std::string_view in, std::uint64_t size) {
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) throw MachineError("out of memory");
  const std::unique_ptr<bz_stream, int (*)(bz_stream*)> owner(&stream, BZ2_bzDecompressEnd);
  stream.next_in = const_cast<char*>(in.data());
  stream.avail_in = static_cast<unsigned>(std::min<std::size_t>(in.size(), UINT32_MAX));
  std::string out;
  std::size_t used = 0;
  for (int status = BZ_OK; status != BZ_STREAM_END && used <= size;) {
    const std::size_t room = make_room(out, used, size);
    stream.next_out = out.data() + used;
    stream.avail_out = static_cast<unsigned>(std::min<std::size_t>(room, UINT32_MAX));
    const unsigned in_before = stream.avail_in, out_before = stream.avail_out;
    status = BZ2_bzDecompress(&stream);
    if (status != BZ_OK && status != BZ_STREAM_END) damaged("bz2");
    if (status == BZ_OK && in_before == stream.avail_in && out_before == stream.avail_out)
      damaged("bz2");
    used += out_before - stream.avail_out;
  }
  out.resize(used);
  return out;
}

}  // namespace

std::string decompress(std::string_view stored, const std::string& compression,
                       std::uint64_t size) {
  std::string out;
  if (compression == "lz4")
    out = from_lz4(stored, size);
  else if (compression == "zstd")
    out = from_zstd(stored, size);
  else if (compression == "bz2")
    out = from_bz2(stored, size);
  else
    throw InputError(fmt::format("is compressed with '{}', which is not supported", compression));
  if (out.size() != size)
    throw InputError(fmt::format("is damaged: it holds {} bytes, not {}",
                                 out.size() > size ? "more" : std::to_string(out.size()), size));
  return out;
}

std::string compress(std::string_view content, const std::string& compression) {
  std::string out;
  std::size_t size = 0;
  if (compression == "lz4") {
    // The decoder of ROS 1 reads only independent blocks.
    LZ4F_preferences_t preferences{};
    preferences.frameInfo.blockMode = LZ4F_blockIndependent;
    preferences.frameInfo.blockSizeID = LZ4F_max4MB;
    preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
    out.resize(LZ4F_compressFrameBound(content.size(), &preferences));
    size = LZ4F_compressFrame(out.data(), out.size(), content.data(), content.size(), &preferences);
    if (LZ4F_isError(size)) throw MachineError("lz4 cannot compress a chunk");
  } else {
    out.resize(ZSTD_compressBound(content.size()));
    size = ZSTD_compress(out.data(), out.size(), content.data(), content.size(), 1);
    if (ZSTD_isError(size)) throw MachineError("zstd cannot compress a chunk");
  }
  out.resize(size);
  return out;
}

}  // namespace mh
