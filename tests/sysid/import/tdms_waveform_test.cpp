#include "sysid/import/tdms_waveform.h"

#include <gtest/gtest.h>

#include <cmath>

namespace softgrip::sysid::tdms_waveform_test {
namespace {

using Series = std::vector<TdmsWaveform::Series>;

/// Returns a waveform with a sampling interval of 0.5 s and 4 values in its first segment.
TdmsWaveform four_values() {
  TdmsWaveform waveform;
  waveform.state("wf_increment", 0.5);
  waveform.state("wf_start_time", TdmsStamp{100, 0.25});
  EXPECT_EQ(waveform.begin_segment(0), "");
  return waveform;
}

TEST(TdmsWaveform, SegmentsWithoutNewPropertiesContinueTheWaveform) {
  TdmsWaveform waveform = four_values();
  EXPECT_EQ(waveform.begin_segment(4), "");
  waveform.state("wf_increment", 0.5);
  waveform.state("wf_start_time", TdmsStamp{100, 0.25});
  waveform.state("unit", 7);
  EXPECT_EQ(waveform.begin_segment(5), "");
  EXPECT_EQ(waveform.times_s(6, 10), (std::vector<double>{10, 10.5, 11, 11.5, 12, 12.5}));
}

TEST(TdmsWaveform, StartAtTheEndOfThePreviousSegmentContinuesTheWaveform) {
  TdmsWaveform waveform = four_values();
  waveform.state("wf_start_time", TdmsStamp{102, 0.3});
  EXPECT_EQ(waveform.begin_segment(4), "");
  EXPECT_EQ(waveform.begin_segment(5), "");
  EXPECT_EQ(waveform.series(), Series(1));
}

TEST(TdmsWaveform, LaterStartBeginsANewSeries) {
  TdmsWaveform waveform = four_values();
  waveform.state("wf_start_time", TdmsStamp{110, 0.25});
  EXPECT_EQ(waveform.begin_segment(4), "");
  EXPECT_EQ(waveform.begin_segment(6), "");
  waveform.state("wf_start_offset", 10);
  EXPECT_EQ(waveform.begin_segment(6), "");
  EXPECT_EQ(waveform.series(), (Series{{0, 0}, {4, 10}, {6, 20}}));
  EXPECT_EQ(waveform.times_s(7, 1), (std::vector<double>{1, 1.5, 2, 2.5, 11, 11.5, 21}));
}

TEST(TdmsWaveform, ContradictoryPropertiesAreReported) {
  TdmsWaveform rate = four_values();
  rate.state("wf_increment", 0.25);
  EXPECT_EQ(rate.begin_segment(4), "wf_increment changes from 0.5 s to 0.25 s");
  EXPECT_EQ(rate.end(4), rate.begin_segment(4));
  TdmsWaveform start = four_values();
  start.state("wf_start_time", TdmsStamp{101, 0.25});
  EXPECT_EQ(start.begin_segment(4),
            "wf_start_time and wf_start_offset state that a segment begins at 1 s after the first value, but "
            "the previous values end at "
            "1.5 s");
  TdmsWaveform offset = four_values();
  offset.state("wf_start_offset", std::nan(""));
  EXPECT_NE(offset.begin_segment(4), "");
}

TEST(TdmsWaveform, SegmentWithoutValuesIsNoSeries) {
  TdmsWaveform waveform = four_values();
  waveform.state("wf_start_time", TdmsStamp{110, 0.25});
  EXPECT_EQ(waveform.begin_segment(4), "");
  EXPECT_EQ(waveform.end(4), "");
  EXPECT_EQ(waveform.series(), Series(1));
}

/// Some programs write the properties after the values.
TEST(TdmsWaveform, FirstStatementAppliesToAllValues) {
  TdmsWaveform waveform;
  EXPECT_EQ(waveform.begin_segment(0), "");
  EXPECT_EQ(waveform.begin_segment(2), "");
  EXPECT_FALSE(waveform.has_times());
  waveform.state("wf_increment", 0.5);
  waveform.state("wf_start_time", TdmsStamp{100, 0.25});
  EXPECT_EQ(waveform.begin_segment(4), "");
  EXPECT_TRUE(waveform.has_times());
  EXPECT_EQ(waveform.start_s(TdmsStamp{98, 0.25}), 2);
  EXPECT_EQ(waveform.times_s(3, 2), (std::vector<double>{2, 2.5, 3}));
}

}  // namespace
}  // namespace softgrip::sysid::tdms_waveform_test
