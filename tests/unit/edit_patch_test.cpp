// The patch as such: RFC 6902's operations and errors (its appendix A, where it applies), pointers, names, limits.
#include <cmath>

#include "tests/unit/edit_scene.h"

namespace lightwell {
namespace {

TEST(Patch, EmptyOneChangesNothing) {
  Scene scene = make_edit_scene();
  const Json before = describe_scene(scene);
  apply_or_fail(scene, Json::array());
  EXPECT_EQ(describe_scene(scene), before);
}

TEST(Patch, AllOrNothing) {
  expect_refused(patch(edit("replace", "/nodes/0/translation", {1, 2, 3}), edit("replace", "/nodes/99/name", "x")),
                 ErrorKind::kNotFound, "/nodes/99/name");
  expect_refused(patch(removal("/materials/0"), removal("/nodes/0"), edit("add", "/nodes/-", {{"mesh", 7}})),
                 ErrorKind::kNotFound, "/nodes/-/mesh");
}

TEST(Patch, SaysWhichEditWasRefused) {
  Scene scene = make_edit_scene();
  const Status applied =
      apply_edits(scene, patch(edit("replace", "/nodes/0/name", "x"), edit("replace", "/nodes/0/name", 1)));
  ASSERT_FALSE(applied.ok());
  EXPECT_EQ(applied.error().message(), "/nodes/0/name: edit 1: must be a string of at most 1024 bytes, not 1");
}

TEST(Patch, CountsWhichEditWasRefused) {
  Scene scene = make_edit_scene();
  std::size_t refused = 99;
  const Json good = edit("replace", "/nodes/0/name", "x");
  EXPECT_FALSE(apply_edits(scene, patch(good, good, removal("/nodes/6"), good), {}, &refused).ok());
  EXPECT_EQ(refused, 2u);
  EditLimits limits;
  limits.max_triangles = 1;
  EXPECT_FALSE(apply_edits(scene, patch(edit("add", "/nodes/-", {{"mesh", 0}})), limits, &refused).ok());
  EXPECT_EQ(refused, 1u);
}

TEST(Patch, OperationsApplyInOrder) {
  Scene scene = make_edit_scene();
  apply_or_fail(scene,
                patch(removal("/materials/0"), edit("test", "/materials/0/name", "green"),
                      edit("add", "/materials/0", {{"name", "new"}}), edit("test", "/materials/1/name", "green")));
}

TEST(Patch, ShapeIsChecked) {
  expect_refused(Json::object(), ErrorKind::kInvalidInput, "");
  expect_refused(patch("x"), ErrorKind::kInvalidInput, "");
  expect_refused(patch(Json{{"op", "remove"}}), ErrorKind::kInvalidInput, "");
  expect_refused(patch(Json{{"op", "remove"}, {"path", 3}}), ErrorKind::kInvalidInput, "");
  expect_refused(patch(Json{{"path", "/nodes/0"}, {"value", 1}}), ErrorKind::kInvalidInput, "/nodes/0");
  expect_refused(patch(Json{{"op", "spam"}, {"path", "/nodes/0"}}), ErrorKind::kInvalidInput, "/nodes/0");
  expect_refused(patch(Json{{"op", "add"}, {"path", "/nodes/-"}}), ErrorKind::kInvalidInput, "/nodes/-");
  expect_refused(patch(Json{{"op", "move"}, {"from", "/nodes/0"}, {"path", "/nodes/1"}}), ErrorKind::kUnsupported,
                 "/nodes/1");
  expect_refused(patch(Json{{"op", "copy"}, {"from", "/nodes/0"}, {"path", "/nodes/1"}}), ErrorKind::kUnsupported,
                 "/nodes/1");
}

TEST(Patch, TooManyOperationsAreRefused) {
  Json all = Json::array();
  for (int i = 0; i < 4097; ++i) all.push_back(edit("test", "/nodes/0/name", "body"));
  expect_refused(all, ErrorKind::kTooLarge, "");
  all.erase(0);
  Scene scene = make_edit_scene();
  apply_or_fail(scene, all);
}

// RFC 6902, A.2 and A.16: a value is added before the element at its index, or at the end.
TEST(Rfc6902, AddsArrayElements) {
  Scene scene = make_edit_scene();
  apply_or_fail(scene, patch(edit("add", "/nodes/0/children/0", 3), edit("add", "/nodes/0/children/-", 5)));
  EXPECT_EQ(scene.nodes[0].children, (std::vector<int>{3, 1, 5}));
}

// A.3, A.4, A.5
TEST(Rfc6902, RemovesMembersAndElementsAndReplacesValues) {
  Scene scene = make_edit_scene();
  apply_or_fail(scene, patch(removal("/nodes/0/mesh"), removal("/nodes/1/children/0"),
                             edit("replace", "/nodes/5/name", "camera")));
  EXPECT_EQ(scene.nodes[0].mesh, -1);
  EXPECT_TRUE(scene.nodes[1].children.empty());
  EXPECT_EQ(scene.nodes[5].name, "camera");
}

// A.8, A.9
TEST(Rfc6902, Tests) {
  Scene scene = make_edit_scene();
  apply_or_fail(scene, patch(edit("test", "/nodes/0/name", "body"), edit("test", "/nodes/0/children", {1}),
                             edit("test", "/nodes/0/children/0", 1), edit("test", "/nodes/0/mesh", 0.0),
                             edit("test", "/nodes/0", {{"name", "body"}, {"mesh", 0}, {"children", {1}}})));
  expect_refused(patch(edit("test", "/nodes/0/name", "bar")), ErrorKind::kInvalidInput, "/nodes/0/name");
  expect_refused(patch(edit("test", "/nodes/0/camera", 0)), ErrorKind::kNotFound, "/nodes/0/camera");
  expect_refused(patch(edit("test", "/nodes/0", {{"name", "body"}})), ErrorKind::kInvalidInput, "/nodes/0");
}

// A.11
TEST(Rfc6902, MembersOfAnOperationThatItDoesNotDefineAreIgnored) {
  Scene scene = make_edit_scene();
  Json operation = edit("replace", "/nodes/0/name", "x");
  operation["xyz"] = 123;
  apply_or_fail(scene, patch(operation));
  EXPECT_EQ(scene.nodes[0].name, "x");
}

// A.12
TEST(Rfc6902, AddToWhatDoesNotExist) {
  expect_refused(patch(edit("add", "/baz/bat", "qux")), ErrorKind::kNotFound, "/baz/bat");
  expect_refused(patch(edit("add", "/nodes/0/baz/bat", "qux")), ErrorKind::kNotFound, "/nodes/0/baz/bat");
  expect_refused(patch(edit("add", "/nodes/8", Json::object())), ErrorKind::kNotFound, "/nodes/8");
  expect_refused(patch(edit("add", "/nodes/0/children/2", 3)), ErrorKind::kNotFound, "/nodes/0/children/2");
}

// A.14
TEST(Rfc6902, TildeEscapes) {
  Scene scene = make_edit_scene();
  apply_or_fail(scene, patch(edit("replace", "/nodes/a~1b~0c/name", "~01")));
  EXPECT_EQ(scene.nodes[5].name, "~01");
  apply_or_fail(scene, patch(edit("replace", "/nodes/~001/name", "back")));
  EXPECT_EQ(scene.nodes[5].name, "back");
  expect_refused(patch(edit("replace", "/materials/0/pbrMetallicRoughness~1metallicFactor", 0)), ErrorKind::kNotFound,
                 "/materials/0/pbrMetallicRoughness~1metallicFactor");
  expect_refused(patch(removal("/nodes/0/name~")), ErrorKind::kInvalidInput, "/nodes/0/name~");
  expect_refused(patch(removal("nodes/0")), ErrorKind::kInvalidInput, "nodes/0");
}

// A.15
TEST(Rfc6902, StringsAreNotNumbers) {
  expect_refused(patch(edit("test", "/nodes/0/mesh", "0")), ErrorKind::kInvalidInput, "/nodes/0/mesh");
  expect_refused(patch(edit("test", "/nodes/0/name", 0)), ErrorKind::kInvalidInput, "/nodes/0/name");
}

TEST(Rfc6902, WhatIsRemovedMustBeThere) {
  expect_refused(patch(removal("/nodes/1/mesh")), ErrorKind::kNotFound, "/nodes/1/mesh");
  expect_refused(patch(removal("/nodes/6")), ErrorKind::kNotFound, "/nodes/6");
  expect_refused(patch(removal("/nodes/-")), ErrorKind::kNotFound, "/nodes/-");
  expect_refused(patch(removal("/nodes/0/children/1")), ErrorKind::kNotFound, "/nodes/0/children/1");
}

TEST(Pointers, IndicesHaveNoLeadingZeros) {
  expect_refused(patch(edit("replace", "/nodes/00/name", "x")), ErrorKind::kNotFound, "/nodes/00/name");
  expect_refused(patch(edit("replace", "/nodes/-1/name", "x")), ErrorKind::kNotFound, "/nodes/-1/name");
  expect_refused(patch(edit("replace", "/nodes/1e0/name", "x")), ErrorKind::kNotFound, "/nodes/1e0/name");
  expect_refused(patch(edit("replace", "/nodes/4294967296/name", "x")), ErrorKind::kNotFound, "/nodes/4294967296/name");
}

TEST(Pointers, WhatCannotBeEdited) {
  for (const char* path : {"",
                           "/",
                           "/nodes",
                           "/meshes",
                           "/asset/version",
                           "/nodes/0/extras",
                           "/nodes/0/",
                           "/nodes//",
                           "/buffers/0/byteLength",
                           "/scenes/1/nodes",
                           "/animations/0/name",
                           "/nodesX/0/name",
                           "/extensions",
                           "/extensions/KHR_lights_punctual",
                           "/extensions/KHR_lights_punctual/lights",
                           "/meshes/0/primitives/1/material",
                           "/meshes/0/primitives/-/material",
                           "/meshes/0/name",
                           "/nodes/0/translation/3",
                           "/nodes/0/translation/x",
                           "/nodes/0/name/0"}) {
    Scene scene = make_edit_scene();
    const Status applied = apply_edits(scene, patch(edit("replace", path, 0)));
    ASSERT_FALSE(applied.ok()) << path;
    EXPECT_EQ(applied.error().where, path);
  }
}

TEST(Names, StandForIndices) {
  Scene scene = make_edit_scene();
  apply_or_fail(scene, patch(edit("replace", "/nodes/rotor/scale", {2, 2, 2}),
                             edit("replace", "/materials/green/doubleSided", true),
                             edit("replace", "/extensions/KHR_lights_punctual/lights/sun/intensity", 5),
                             edit("replace", "/cameras/front/perspective/yfov", 1),
                             edit("replace", "/nodes/rotor/mesh", "blue triangle"),
                             edit("replace", "/meshes/red triangle/primitives/0/material", "green"),
                             edit("add", "/nodes/body/children/-", "lamp")));
  EXPECT_EQ(scene.nodes[1].local.scale.x, 2.0f);
  EXPECT_TRUE(scene.materials[1].double_sided);
  EXPECT_EQ(scene.lights[0].intensity, 5.0f);
  EXPECT_EQ(scene.cameras[0].yfov, 1.0f);
  EXPECT_EQ(scene.nodes[1].mesh, 1);
  EXPECT_EQ(scene.meshes[0]->primitives[0].material, 1);
  EXPECT_EQ(scene.nodes[0].children, (std::vector<int>{1, 3}));
}

TEST(Names, MustBeOneObjects) {
  Scene scene = make_edit_scene();
  scene.nodes[3].name = "rotor";
  expect_refused(patch(edit("replace", "/nodes/rotor/name", "x")), ErrorKind::kInvalidInput, "/nodes/rotor/name",
                 scene);
  expect_refused(patch(edit("replace", "/nodes/motor/name", "x")), ErrorKind::kNotFound, "/nodes/motor/name", scene);
  expect_refused(patch(edit("replace", "/nodes/0/mesh", "cube")), ErrorKind::kNotFound, "/nodes/0/mesh", scene);
}

TEST(Limits, OfWhatAPatchMayAdd) {
  Scene scene = make_edit_scene();
  EditLimits limits;
  limits.max_nodes = 7;
  limits.max_lights = 2;
  limits.max_triangles = 3;
  EXPECT_TRUE(apply_edits(scene, patch(edit("add", "/nodes/-", {{"mesh", 0}})), limits).ok());
  EXPECT_EQ(apply_edits(scene, patch(edit("add", "/nodes/-", Json::object())), limits).error().kind,
            ErrorKind::kTooLarge);
  EXPECT_EQ(
      apply_edits(scene, patch(edit("add", "/extensions/KHR_lights_punctual/lights/-", {{"type", "spot"}})), limits)
          .error()
          .kind,
      ErrorKind::kTooLarge);
  EXPECT_EQ(apply_edits(scene, patch(edit("replace", "/nodes/4/mesh", 0)), limits).error().kind, ErrorKind::kTooLarge);
  limits.max_triangles = 1;  // a scene that is beyond it already can still be edited
  EXPECT_TRUE(apply_edits(scene, patch(edit("replace", "/nodes/4/name", "x")), limits).ok());
}

TEST(Limits, OfThePatchesWork) {
  Scene scene;
  scene.nodes.resize(100'000);
  for (int i = 0; i < 100'000; ++i) scene.roots.push_back(i);
  Json all = Json::array();
  for (int i = 0; i < 4096; ++i) all.push_back(edit("replace", "/nodes/nobody/name", "x"));
  EXPECT_EQ(apply_edits(scene, all).error().kind, ErrorKind::kNotFound);
  scene.nodes.back().name = "last";
  for (int i = 0; i < 4096; ++i) all[static_cast<std::size_t>(i)] = edit("replace", "/nodes/last/scale", {1, 1, 1});
  EXPECT_EQ(apply_edits(scene, all).error().kind, ErrorKind::kTooLarge);
}

}  // namespace
}  // namespace lightwell
