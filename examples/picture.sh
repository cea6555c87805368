#!/usr/bin/env bash
# A picture with curl: renders a scene of the server's, or uploads a .glb and renders that.
#   examples/picture.sh picture.png [room.glb]
# LIGHTWELL_URL (http://127.0.0.1:8080) is the server, LIGHTWELL_TOKEN the token if it asks for one.
set -euo pipefail
picture=${1:?usage: picture.sh PICTURE.png [SCENE.glb]}
url=${LIGHTWELL_URL:-http://127.0.0.1:8080}
curl=(curl --fail-with-body --silent --show-error)
[[ -z ${LIGHTWELL_TOKEN:-} ]] || curl+=(--header "Authorization: Bearer $LIGHTWELL_TOKEN")

scene=atrium
if [[ -n ${2:-} ]]; then
  scene=example-upload
  "${curl[@]}" --upload-file "$2" --header 'Content-Type: model/gltf-binary' "$url/v1/scenes/$scene" >&2
  echo >&2
fi

fields=$("${curl[@]}" --json "{\"scene\":\"$scene\",\"width\":320,\"height\":180,\"settings\":{\"samples\":16},\"spp_frames\":4}" \
  --output "$picture" --dump-header - "$url/v1/render")
grep --ignore-case '^server-timing' <<< "$fields" >&2
echo "$picture"
