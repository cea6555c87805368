// Where a .gltf may take its buffers and images from: its own folder, and itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/unit/gltf_builder.h"

namespace lightwell {
namespace {

using nlohmann::json;
using testing::HasSubstr;

std::string base64(const ByteVector& bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t b = 0; b < 3; ++b)
      bits = bits << 8 | (i + b < bytes.size() ? std::to_integer<std::uint32_t>(bytes[i + b]) : 0);
    for (std::size_t digit = 0; digit < 4; ++digit)
      text += i + digit > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * digit) & 63];
  }
  return text;
}

/// A triangle in a .gltf whose buffer lies elsewhere; and a folder of its own for every test.
class GltfFiles : public testing::Test {
 protected:
  void SetUp() override {
    home_ = std::filesystem::path(testing::TempDir()) /
            ("lightwell_gltf_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::remove_all(home_);
    std::filesystem::create_directories(home_ / "asset" / "sub");
    builder_ = GltfBuilder::triangle();
  }
  void TearDown() override { std::filesystem::remove_all(home_); }

  void write(const std::filesystem::path& path, const ByteVector& bytes) const {
    std::ofstream(home_ / path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }

  /// Loads the triangle with that URI for its buffer.
  Result<Scene> load_with(const std::string& uri, const LoadLimits& limits = {}) {
    builder_.root["buffers"] = {{{"byteLength", builder_.binary.size()}, {"uri", uri}}};
    std::ofstream(home_ / "asset" / "model.gltf") << builder_.root.dump();
    return load_gltf(home_ / "asset" / "model.gltf", limits);
  }

  Error error_with(const std::string& uri) {
    const Result<Scene> scene = load_with(uri);
    EXPECT_FALSE(scene.ok()) << uri;
    return scene ? Error{} : scene.error();
  }

  std::filesystem::path home_;
  GltfBuilder builder_;
};

TEST_F(GltfFiles, BesideTheFile) {
  write("asset/data.bin", builder_.binary);
  const Result<Scene> scene = load_with("data.bin");
  ASSERT_TRUE(scene.ok()) << scene.error().message();
  EXPECT_EQ(scene->meshes[0]->primitives[0].positions[1], glm::vec3(1, 0, 0));
  EXPECT_EQ(scene->name, "model");
}

TEST_F(GltfFiles, InAFolderBelowIt) {
  write("asset/sub/a b+c%.bin", builder_.binary);
  EXPECT_TRUE(load_with("sub/a%20b+c%25.bin").ok());
  EXPECT_TRUE(load_with("./sub/a b+c%25.bin").ok());
}

TEST_F(GltfFiles, LongerThanItMustBe) {
  ByteVector longer = builder_.binary;
  longer.resize(longer.size() + 5);
  write("asset/data.bin", longer);
  EXPECT_TRUE(load_with("data.bin").ok());
}

TEST_F(GltfFiles, ShorterThanItMustBe) {
  write("asset/data.bin", ByteVector(builder_.binary.begin(), builder_.binary.end() - 1));
  EXPECT_EQ(error_with("data.bin").where, "buffers/0");
}

TEST_F(GltfFiles, NothingOutsideTheFolder) {
  write("secret.bin", builder_.binary);
  const std::string absolute = (home_ / "secret.bin").string();
  for (const std::string& uri :
       {std::string("../secret.bin"), std::string("sub/../../secret.bin"), std::string("sub/../model.gltf"),
        std::string("%2e%2e/secret.bin"), std::string("..%2fsecret.bin"), std::string("..%2Fsecret.bin"),
        std::string("..%5csecret.bin"), std::string("..\\secret.bin"), absolute, "/" + absolute, "file://" + absolute,
        "file:" + absolute, std::string("http://localhost/secret.bin"), std::string("secret.bin%00.bin"),
        std::string("%zz.bin"), std::string("secret%2"), std::string("")}) {
    SCOPED_TRACE(uri);
    const Error error = error_with(uri);
    EXPECT_EQ(error.kind, ErrorKind::kInvalidInput);
    EXPECT_EQ(error.where, "buffers/0/uri");
  }
}

TEST_F(GltfFiles, NoLinksOutOfTheFolder) {
  write("secret.bin", builder_.binary);
  std::filesystem::create_symlink("../secret.bin", home_ / "asset" / "link.bin");
  EXPECT_THAT(error_with("link.bin").what, HasSubstr("out of the asset's own folder"));
  std::filesystem::create_directory_symlink("..", home_ / "asset" / "up");
  EXPECT_THAT(error_with("up/secret.bin").what, HasSubstr("out of the asset's own folder"));
  // A folder whose name only begins with the asset's is another folder.
  std::filesystem::create_directories(home_ / "asset2");
  write("asset2/data.bin", builder_.binary);
  std::filesystem::create_symlink("../asset2/data.bin", home_ / "asset" / "neighbour.bin");
  EXPECT_THAT(error_with("neighbour.bin").what, HasSubstr("out of the asset's own folder"));
}

TEST_F(GltfFiles, LinksWithinTheFolderAreFine) {
  write("asset/data.bin", builder_.binary);
  std::filesystem::create_symlink("../data.bin", home_ / "asset" / "sub" / "link.bin");
  EXPECT_TRUE(load_with("sub/link.bin").ok());
}

TEST_F(GltfFiles, OnlyRegularFiles) {
  EXPECT_THAT(error_with("sub").what, HasSubstr("not a file"));
  EXPECT_EQ(error_with("missing.bin").kind, ErrorKind::kNotFound);
}

TEST_F(GltfFiles, TheSizeOfAllFilesIsLimited) {
  write("asset/data.bin", ByteVector(100'000));
  LoadLimits limits;
  limits.max_file_bytes = 50'000;
  const Result<Scene> scene = load_with("data.bin", limits);
  ASSERT_FALSE(scene.ok());
  EXPECT_EQ(scene.error().kind, ErrorKind::kTooLarge);
}

TEST_F(GltfFiles, DataUris) {
  const std::string data = base64(builder_.binary);
  for (const char* type : {"application/octet-stream", "application/gltf-buffer", "", "text/plain;charset=x"})
    EXPECT_TRUE(load_with(std::string("data:") + type + ";base64," + data).ok()) << type;
  EXPECT_TRUE(load_with("DATA:;base64," + data).ok());
  for (const std::string& uri : {"data:;base64," + data.substr(0, 5), "data:;base64," + data.substr(4),
                                 "data:;base64,####" + data, std::string("data:;base64"), std::string("data:,plain")}) {
    SCOPED_TRACE(uri);
    EXPECT_EQ(error_with(uri).kind, ErrorKind::kInvalidInput);
  }
}

TEST_F(GltfFiles, ExternalAndEmbeddedImages) {
  write("asset/data.bin", builder_.binary);
  write("asset/image.png", one_pixel_png({1, 2, 3, 4}));
  builder_.add("images", {{"uri", "image.png"}});
  builder_.add("images", {{"uri", "data:image/png;base64," + base64(one_pixel_png({5, 6, 7, 8}))}});
  builder_.add("images", {{"uri", "nowhere.ktx2"}});  // of no account while no material shows it
  for (int i = 0; i < 3; ++i) builder_.add("textures", {{"source", i}});
  builder_.add("materials", {{"emissiveTexture", {{"index", 1}}}, {"occlusionTexture", {{"index", 0}}}});
  const Result<Scene> scene = load_with("data.bin");
  ASSERT_TRUE(scene.ok()) << scene.error().message();
  ASSERT_EQ(scene->images.size(), 2u);
  const auto image_of = [&](int texture) {
    return scene->images[static_cast<std::size_t>(scene->textures[static_cast<std::size_t>(texture)].image)]->rgba;
  };
  EXPECT_THAT(image_of(0), testing::ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(image_of(1), testing::ElementsAre(5, 6, 7, 8));
  builder_.root["materials"][0]["emissiveTexture"]["index"] = 2;
  const Error error = error_with("data.bin");
  EXPECT_EQ(error.where, "images/2/uri");
  EXPECT_EQ(error.kind, ErrorKind::kNotFound);
}

TEST_F(GltfFiles, AGlbFromAFile) {
  write("asset/model.glb", builder_.glb());
  const Result<Scene> scene = load_gltf(home_ / "asset" / "model.glb");
  ASSERT_TRUE(scene.ok()) << scene.error().message();
  EXPECT_EQ(scene->name, "model");
}

TEST_F(GltfFiles, TheFileItself) {
  EXPECT_EQ(load_gltf(home_ / "missing.glb").error().kind, ErrorKind::kNotFound);
  EXPECT_EQ(load_gltf(home_).error().kind, ErrorKind::kInvalidInput);
  EXPECT_EQ(load_gltf("/dev/zero").error().kind, ErrorKind::kInvalidInput);
  write("empty.glb", {});
  EXPECT_EQ(load_gltf(home_ / "empty.glb").error().kind, ErrorKind::kInvalidInput);
}

TEST_F(GltfFiles, FromTheWorkingFolder) {
  const std::filesystem::path before = std::filesystem::current_path();
  write("asset/data.bin", builder_.binary);
  ASSERT_TRUE(load_with("data.bin").ok());
  std::filesystem::current_path(home_ / "asset");
  const bool loads = load_gltf("model.gltf").ok();
  std::filesystem::current_path(before);
  EXPECT_TRUE(loads);
}

}  // namespace
}  // namespace lightwell
