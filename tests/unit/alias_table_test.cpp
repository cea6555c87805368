// The alias table: what it would choose, added up exactly over its entries, is what the weights ask for.
#include "renderer/passes/alias_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace lightwell {
namespace {

/// The probability of each choice: every entry is taken alike, then itself by its threshold, else its alias.
std::vector<double> chosen(const std::vector<AliasEntry>& table) {
  std::vector<double> probability(table.size(), 0.0);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double threshold = std::min(1.0, static_cast<double>(table[i].threshold));
    probability[i] += threshold / static_cast<double>(table.size());
    probability[table[i].alias] += (1.0 - threshold) / static_cast<double>(table.size());
  }
  return probability;
}

void expect_chosen_by_weight(const std::vector<double>& weights) {
  const std::vector<AliasEntry> table = make_alias_table(weights);
  ASSERT_EQ(table.size(), weights.size());
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  const std::vector<double> probability = chosen(table);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    ASSERT_NEAR(probability[i], weights[i] / sum, 1e-6) << "entry " << i;
    ASSERT_NEAR(static_cast<double>(table[i].probability), weights[i] / sum, 1e-6) << "entry " << i;
    ASSERT_LT(table[i].alias, weights.size());
    ASSERT_EQ(table[i].alias_probability, table[table[i].alias].probability) << "entry " << i;
    if (weights[i] == 0.0) {
      ASSERT_EQ(probability[i], 0.0) << "entry " << i;
    }
  }
}

TEST(AliasTable, ChoosesByWeight) {
  expect_chosen_by_weight({1.0});
  expect_chosen_by_weight({1.0, 1.0, 1.0});
  expect_chosen_by_weight({1.0, 2.0, 3.0, 4.0});
  expect_chosen_by_weight({1e-9, 1.0});
  expect_chosen_by_weight({1000.0, 1.0, 1.0, 1.0, 1.0});
}

TEST(AliasTable, NeverChoosesWhatWeighsNothing) {
  expect_chosen_by_weight({0.0, 1.0});
  expect_chosen_by_weight({1.0, 0.0, 0.0, 0.0, 2.0, 0.0});
  std::vector<double> one_of_many(1000, 0.0);
  one_of_many[517] = 1e-12;
  expect_chosen_by_weight(one_of_many);
}

TEST(AliasTable, ChoosesByWeightAmongManyOfAllSizes) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> exponent(-6.0, 6.0);
  std::vector<double> weights(4097);
  for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = i % 5 == 0 ? 0.0 : std::pow(10.0, exponent(random));
  expect_chosen_by_weight(weights);
}

TEST(AliasTable, IsEmptyWhereThereIsNothingToChoose) {
  EXPECT_TRUE(make_alias_table({}).empty());
  EXPECT_TRUE(make_alias_table(std::vector<double>{0.0, 0.0}).empty());
}

TEST(AliasTable, DividesWhatSumsToInfinity) {
  const double most = std::numeric_limits<double>::max();
  const std::vector<AliasEntry> table = make_alias_table(std::vector<double>{most, most, 0.5 * most});
  ASSERT_EQ(table.size(), 3u);
  EXPECT_NEAR(table[0].probability, 0.4, 1e-6);
  EXPECT_NEAR(table[2].probability, 0.2, 1e-6);
  const double least = std::numeric_limits<double>::denorm_min();
  EXPECT_NEAR(make_alias_table(std::vector<double>{least, least})[1].probability, 0.5, 1e-6);
}

}  // namespace
}  // namespace lightwell
