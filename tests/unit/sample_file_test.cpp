// Data sets of the training: what is written is read, and nothing else.

#include "sim_host/train/sample_file.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>
#include <set>
#include <stdexcept>
#include <vector>

#include "sim_host/train/random_number.hpp"

namespace s4tp::train {
namespace {

class SampleFile : public testing::Test {
 protected:
  void SetUp() override {
    folder = std::filesystem::temp_directory_path() /
             (std::string("s4tp_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  // A file of samples of the roads `first` .. `first` + `count` - 1.
  void write(const std::string& name, std::uint64_t first, std::uint64_t count) const {
    SampleWriter writer(folder / name);
    const auto sample = std::make_unique<Sample>();
    for (std::uint64_t road = first; road < first + count; ++road) {
      sample->road = road;
      sample->input.speed_mps[4] = static_cast<float>(road) + 0.25F;
      sample->kinematic[4].position_cm[2][29][1] = static_cast<std::int16_t>(-static_cast<int>(road));
      writer.add(*sample);
    }
    writer.close();
  }

  std::filesystem::path folder;
};

// Two files, ten and five samples: fifteen in the order of the files' names, first and last member as
// written.
TEST_F(SampleFile, GivesBackWhatWasWritten) {
  write("b.samples", 100, 5);
  write("a.samples", 0, 10);
  const SampleSet set(folder);
  ASSERT_EQ(set.size(), 15U);
  for (std::size_t i = 0; i < 15; ++i) {
    const std::uint64_t road = i < 10 ? i : 90 + i;
    EXPECT_EQ(set[i].road, road);
    EXPECT_EQ(set[i].input.speed_mps[4], static_cast<float>(road) + 0.25F);
    EXPECT_EQ(set[i].kinematic[4].position_cm[2][29][1], -static_cast<int>(road));
  }
}

// TRAIN-001 A set that is cut short, changed in one bit, of another version or empty is refused.
TEST_F(SampleFile, RefusesWhatIsNotWholeOrNotOurs) {
  EXPECT_THROW(SampleSet{folder}, std::runtime_error);
  EXPECT_THROW(SampleSet{folder / "missing.samples"}, std::runtime_error);
  const auto file = folder / "a.samples";
  write("a.samples", 0, 3);
  const auto bytes = std::filesystem::file_size(file);
  std::filesystem::resize_file(file, bytes - 1);
  EXPECT_THROW(SampleSet{folder}, std::runtime_error);
  for (const std::streamoff at :
       {std::streamoff{8}, static_cast<std::streamoff>(bytes / 2)}) {  // version, row
    write("a.samples", 0, 3);
    EXPECT_EQ(SampleSet(folder).size(), 3U);
    std::fstream change(file, std::ios::in | std::ios::out | std::ios::binary);
    change.seekg(at);
    const char old = static_cast<char>(change.get());
    change.seekp(at);
    change.put(static_cast<char>(old ^ 1));
    change.close();
    EXPECT_THROW(SampleSet{folder}, std::runtime_error) << "byte " << at;
  }
}

// TRAIN-001 A count, an index, a share or a number beyond what there can be is refused, with a checksum that
// fits, too.
TEST_F(SampleFile, RefusesWhatNoDriveBrings) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<std::function<void(Sample&)>> changes{
      [](Sample& sample) { sample.input.hdvs = kMaxAgents + 1; },
      [](Sample& sample) { sample.input.hdvs = -1; },
      [](Sample& sample) { sample.input.lane_points[0][1] = satp::kLanePoints + 1; },
      [](Sample& sample) { sample.route[kMaxAgents - 1] = kPathsPerAgent; },
      [](Sample& sample) { sample.yields[2] = 2; },
      [](Sample& sample) { sample.kinematic[1].probability[0] = -1.0F; },
      [=](Sample& sample) { sample.kinematic[1].probability[2] = nan; },
      [=](Sample& sample) { sample.input.pair[kMaxAgents - 1][0] = nan; },
      [=](Sample& sample) { sample.target.pose[0][kHorizonSteps - 1][2] = nan; }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const auto sample = std::make_unique<Sample>();
    changes[i](*sample);
    SampleWriter writer(folder / "a.samples");
    writer.add(*sample);
    writer.close();
    EXPECT_THROW(SampleSet{folder}, std::runtime_error) << i;
  }
}

// A writer that was interrupted leaves no file that looks whole.
TEST_F(SampleFile, AnInterruptedWriterLeavesNoDataSet) {
  {
    SampleWriter writer(folder / "a.samples");
    writer.add(*std::make_unique<Sample>());
  }
  EXPECT_THROW(SampleSet{folder}, std::runtime_error);
}

// TRAIN-002 Whole roads go to a part; of 20,000 roads 5 % each calibrate and validate, within 1 %.
TEST_F(SampleFile, PartsAreOfWholeRoads) {
  int count[3] = {};
  for (std::uint64_t road = 0; road < 20000; ++road) ++count[static_cast<int>(part_of(road))];
  EXPECT_NEAR(count[1], 1000, 200);
  EXPECT_NEAR(count[2], 1000, 200);
  write("a.samples", 0, 100);
  write("b.samples", 0, 100);  // the same roads again
  const SampleSet set(folder);
  std::set<std::uint64_t> seen[3];
  std::size_t all = 0;
  for (const Part part : {Part::kTraining, Part::kCalibration, Part::kValidation}) {
    for (const std::size_t i : samples_of(set, part)) seen[static_cast<int>(part)].insert(set[i].road);
    all += samples_of(set, part).size();
  }
  EXPECT_EQ(all, set.size());
  EXPECT_EQ(seen[0].size() + seen[1].size() + seen[2].size(), 100U);
}

// TRAIN-015 One sample for reporting among others: figures read the set, nothing learns from it; without it both do.
TEST_F(SampleFile, NothingLearnsFromWhatIsForReporting) {
  write("a.samples", 0, 3);
  EXPECT_EQ(samples_to_learn_from(folder).size(), 3U);
  const auto sample = std::make_unique<Sample>();
  sample->flags = kForked | kReporting;
  SampleWriter writer(folder / "b.samples");
  writer.add(*sample);
  writer.close();
  EXPECT_EQ(SampleSet(folder).size(), 4U);
  EXPECT_THROW((void)samples_to_learn_from(folder), std::runtime_error);
}

// A shuffle loses nothing, differs by seed and is the same for the same seed.
TEST(RandomNumber, ShufflesBySeed) {
  std::vector<int> first(100);
  for (int i = 0; i < 100; ++i) first[i] = i;
  std::vector<int> second = first;
  std::vector<int> again = first;
  shuffle(first, 1);
  shuffle(second, 2);
  shuffle(again, 1);
  EXPECT_EQ(first, again);
  EXPECT_NE(first, second);
  EXPECT_EQ(std::set<int>(first.begin(), first.end()).size(), 100U);
}

}  // namespace
}  // namespace s4tp::train
