// SPDX-License-Identifier: Apache-2.0
#include "burin/job/file_kind.h"

#include <gtest/gtest.h>

#include <string>

namespace burin::job {
namespace {

TEST(FileKind, ContentDecides) {
  EXPECT_EQ(kind_of_file("PARTNO A\nGOTO/1,2,3\nFINI\n", "x.nc"), FileKind::cl);
  EXPECT_EQ(kind_of_file("$$ remark\nCUTTER / 6,3\nGOTO / 1,2,3\n", ""), FileKind::cl);
  EXPECT_EQ(kind_of_file("%\nO1000 (PART)\nN10 G0 X1\n", "a.cl"), FileKind::nc);
  EXPECT_EQ(kind_of_file("g20 g64 g17\ng0x-.2y-.2z0\nf30\n", ""), FileKind::nc);
  EXPECT_EQ(kind_of_file("(a comment)\nT1 M6\n", ""), FileKind::nc);
  EXPECT_EQ(kind_of_file("# a job\n\n[part]\nsection = \"a.dxf\"\n", ""), FileKind::job);
  EXPECT_EQ(kind_of_file("ISO-10303-21;\nHEADER;\n", ""), FileKind::step);
  EXPECT_EQ(kind_of_file("solid a\n facet normal 0 0 1\n", ""), FileKind::stl);
  EXPECT_EQ(kind_of_file("  0\r\nSECTION\r\n  2\r\nHEADER\r\n", ""), FileKind::dxf);
  EXPECT_EQ(kind_of_file("999\nmade by\n0\nSECTION\n", ""), FileKind::dxf);
  EXPECT_EQ(kind_of_file("AutoCAD Binary DXF\r\n\x1a", ""), FileKind::dxf);
  EXPECT_EQ(kind_of_file("<?xml version='1.0'?>\n<svg width='1'/>", ""), FileKind::svg);
  EXPECT_EQ(kind_of_file("\xef\xbb\xbf{\"operation\": \"laser\"}", ""), FileKind::json);
  EXPECT_EQ(kind_of_file("x,y,z,nx,ny,nz\n1,2,3,0,0,1\n", ""), FileKind::csv);
  std::string iges(72, ' ');
  iges += "S      1\n";
  EXPECT_EQ(kind_of_file(iges, ""), FileKind::iges);
  std::string stl = "solid by a careless writer";
  stl.resize(84, '\0');
  stl[80] = 2;
  stl.resize(84 + 100, '\0');
  EXPECT_EQ(kind_of_file(stl, "a.nc"), FileKind::stl);
}

TEST(FileKind, TheNameHelpsWhereTheContentDoesNot) {
  EXPECT_EQ(kind_of_file("", "a.STEP"), FileKind::step);
  EXPECT_EQ(kind_of_file("?", "job.toml"), FileKind::job);
  EXPECT_EQ(kind_of_file("hello world\n", "a.txt"), FileKind::unknown);
  EXPECT_EQ(kind_of_file(std::string(300, '\0'), ""), FileKind::unknown);
  EXPECT_EQ(describe(FileKind::unknown), "of no known kind");
}

}  // namespace
}  // namespace burin::job
