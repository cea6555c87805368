#include "renderer/tracing/thread_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

namespace lightwell {
namespace {

TEST(ThreadPool, CoversEveryIndexOnceInChunksThatStartAtMultiples) {
  for (const unsigned threads : {1u, 2u, 7u}) {
    ThreadPool pool(threads);
    EXPECT_EQ(pool.thread_count(), threads);
    for (const std::uint32_t count : {0u, 1u, 31u, 32u, 33u, 1000u}) {
      std::vector<std::atomic<int>> calls(count);
      pool.parallel_for(count, 32, [&](std::uint32_t begin, std::uint32_t end) {
        EXPECT_EQ(begin % 32, 0u);
        EXPECT_LE(end - begin, 32u);
        for (std::uint32_t i = begin; i < end; ++i) ++calls[i];
      });
      for (const auto& n : calls) EXPECT_EQ(n.load(), 1);
    }
  }
}

TEST(ThreadPool, ManyShortLoopsInARow) {
  ThreadPool pool(4);
  std::uint64_t expected = 0;
  std::atomic<std::uint64_t> sum{0};
  for (std::uint32_t loop = 0; loop < 3000; ++loop) {
    const std::uint32_t count = loop % 17;
    expected += count * (count + 1) / 2;
    pool.parallel_for(count, 1, [&](std::uint32_t begin, std::uint32_t) { sum += begin + 1; });
  }
  EXPECT_EQ(sum.load(), expected);
}

TEST(ThreadPool, CountsUpToTheLastOf32Bits) {
  ThreadPool pool(2);
  std::atomic<std::uint64_t> covered{0};
  pool.parallel_for(0xffffffffu, 0x10000000u, [&](std::uint32_t begin, std::uint32_t end) { covered += end - begin; });
  EXPECT_EQ(covered.load(), 0xffffffffull);
}

}  // namespace
}  // namespace lightwell
