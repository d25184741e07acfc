// Studies: a row for each combination of values, the same bits as runs, failures as rows, and going on.
#include "command_fixture.h"

namespace pliant {
namespace {

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells{""};
  for (const char c : line)
    if (c == ',')
      cells.emplace_back();
    else
      cells.back() += c;
  return cells;
}

class Study : public Command {
 protected:
  std::vector<std::string> table() const { return lines_of(slurp(folder_ / "t.csv")); }
};

TEST_F(Study, HasARowForEachCombinationWithTheHashOfARun) {
  const std::string vary = "study small.json --vary /settings/substeps=2,4 --vary /objects/0/cloth/material=silk,denim";
  const Result result = pliant(vary + " --measure /particles --out t.csv");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("4 variants, 0 of them from an earlier table, 0 failed"), std::string::npos) << result.out;
  const std::vector<std::string> rows = table();
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(rows[0],
            "/settings/substeps,/objects/0/cloth/material,fingerprint,ok,frames,state_hash,ms_per_frame,mean_substeps,"
            "worst_p99_overstretch,worst_overstretch,/particles,problem");
  std::set<std::string> hashes;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const std::vector<std::string> cells = cells_of(rows[i]);
    EXPECT_EQ(cells[0], i < 3 ? "2" : "4");
    EXPECT_EQ(cells[1], i % 2 == 1 ? "silk" : "denim");
    EXPECT_EQ(cells[10], "144");
    const std::string out =
        pliant("run small.json --set /settings/substeps=" + cells[0] + " --set /objects/0/cloth/material=" + cells[1])
            .out;
    EXPECT_NE(out.find("state " + cells[5]), std::string::npos) << rows[i];
    hashes.insert(cells[5]);
  }
  EXPECT_EQ(hashes.size(), 4u);
}

TEST_F(Study, GoesOnWhereItWasStopped) {
  ASSERT_EQ(pliant("study small.json --vary /frames=1,2,3 --out t.csv --quiet").status, 0);
  const std::vector<std::string> whole = table();
  {
    std::ofstream cut(folder_ / "t.csv");
    cut << whole[0] << '\n' << whole[2] << '\n';
  }
  const Result again = pliant("study small.json --vary /frames=1,2,3 --out t.csv --jobs 1");
  EXPECT_NE(again.out.find("3 variants, 1 of them from an earlier table"), std::string::npos) << again.out;
  ASSERT_EQ(table().size(), 4u);
  EXPECT_EQ(table()[2], whole[2]);
  for (int i = 1; i < 4; ++i) EXPECT_EQ(cells_of(table()[i])[4], cells_of(whole[i])[4]);
  const Result other = pliant("study small.json --vary /settings/substeps=1,2 --out t.csv");
  EXPECT_EQ(other.status, 1);
  EXPECT_NE(other.err.find("its columns differ; name another file"), std::string::npos) << other.err;
}

TEST_F(Study, KeepsOtherRowsAndRunsAgainWhatHasChanged) {
  ASSERT_EQ(pliant("study small.json --vary /settings/substeps=1,2 --out t.csv --quiet").status, 0);
  const std::vector<std::string> first = table();
  EXPECT_NE(pliant("study small.json --vary /settings/substeps=2,3 --out t.csv").out.find("1 of them from an earlier"),
            std::string::npos);
  ASSERT_EQ(table().size(), 4u);
  EXPECT_EQ(table()[1], first[2]);
  EXPECT_EQ(table()[3], first[1]) << "the row of another study stays";
  EXPECT_NE(pliant("study small.json --vary /settings/substeps=2,3 --frames 2 --out t.csv").out.find("0 of them from"),
            std::string::npos);
  ASSERT_EQ(table().size(), 4u);
  EXPECT_NE(table()[1], first[2]);
}

TEST_F(Study, AFailureIsARow) {
  const Result result = pliant("study small.json --vary /settings/substeps=0.5,2 --out t.csv");
  EXPECT_EQ(result.status, 1);
  ASSERT_EQ(table().size(), 3u);
  EXPECT_NE(table()[1].find("/settings/substeps"), std::string::npos) << table()[1];
  EXPECT_EQ(cells_of(table()[1])[2], "false");
  EXPECT_EQ(cells_of(table()[2])[2], "true");
  const Result again = pliant("study small.json --vary /settings/substeps=0.5,2 --out t.csv");
  EXPECT_EQ(again.status, 1) << "what failed is tried again";
  EXPECT_NE(again.out.find("1 of them from an earlier table, 1 failed"), std::string::npos) << again.out;
}

TEST_F(Study, ValuesMayBeLists) {
  ASSERT_EQ(pliant("study small.json --vary '/gravity=[0,-9.81,0],[0,-1.6,0]' --out t.csv --quiet").status, 0);
  ASSERT_EQ(table().size(), 3u);
  EXPECT_EQ(table()[2].rfind("\"[0,-1.6,0]\",", 0), 0u) << table()[2];
}

TEST_F(Study, RefusesWhatItCannotDo) {
  const auto refusal = [&](const std::string& arguments) {
    const Result result = pliant("study small.json --out t.csv " + arguments);
    EXPECT_NE(result.status, 0) << arguments;
    return result.err;
  };
  EXPECT_NE(refusal("").find("--vary"), std::string::npos);
  EXPECT_NE(refusal("--vary /frames").find("varies nothing"), std::string::npos);
  EXPECT_NE(refusal("--vary /frames=1,,2").find("empty value"), std::string::npos);
  EXPECT_NE(refusal("--vary /frames=1 --vary /frames=2").find("varied twice"), std::string::npos);
  EXPECT_NE(refusal("--vary /frames=1 --measure particles").find("no JSON pointer"), std::string::npos);
  EXPECT_NE(refusal("--vary /frames=1 --pictures a.jpg").find(".png"), std::string::npos);
  EXPECT_NE(pliant("study none.json --vary /frames=1 --out t.csv").err.find("none.json"), std::string::npos);
  EXPECT_NE(pliant("study small.json --vary /frames=1 --out small.json").status, 0);
}

}  // namespace
}  // namespace pliant
