// SPDX-License-Identifier: Apache-2.0
// Reads an MCAP file with the npm packages that Foxglove is made of, each message by the definition in the file,
// and compares it with the replay's own numbers.
//   node decode.cjs NODE_MODULES FILE.mcap REPLAY_FOLDER
const fs = require("fs");
const path = require("path");
const [, , modules, file, replay] = process.argv;
const load = require("module").createRequire(path.join(path.resolve(modules), "any.js"));
const { McapIndexedReader } = load("@mcap/core");
const { parse } = load("@foxglove/rosmsg");
const { MessageReader } = load("@foxglove/rosmsg2-serialization");
const { decompress } = load("fzstd");

function need(holds, what) {
    if (!holds) {
        console.error("npm: " + what);
        process.exit(1);
    }
}

const bytes = fs.readFileSync(file);
const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => new Uint8Array(bytes.subarray(Number(offset), Number(offset) + Number(size))),
};

function columns() {
    const [head, ...rows] = fs.readFileSync(path.join(replay, "haptics.csv"), "utf8").trim().split("\n");
    const names = head.split(",");
    return rows.map((row) => Object.fromEntries(row.split(",").map((value, i) => [names[i], Number(value)])));
}

const near = (a, b) => Math.abs(a - b) < 1e-9 * Math.max(1, Math.abs(b));

async function main() {
    const reader = await McapIndexedReader.Initialize({
        readable,
        decompressHandlers: { zstd: (packed, size) => decompress(packed, new Uint8Array(Number(size))) },
    });
    const decoders = new Map();
    const heard = {};
    for await (const message of reader.readMessages()) {
        const channel = reader.channelsById.get(message.channelId);
        if (!decoders.has(message.channelId)) {
            const schema = reader.schemasById.get(channel.schemaId);
            const definition = new TextDecoder().decode(schema.data);
            decoders.set(message.channelId, new MessageReader(parse(definition, { ros2: true })));
        }
        (heard[channel.topic] ??= []).push(decoders.get(message.channelId).readMessage(message.data));
    }
    const ticks = columns(), wrenches = heard["/fathom/wrench"], tools = heard["/fathom/tool_pose"];
    need(wrenches.length === ticks.length && tools.length === ticks.length, "another number of ticks");
    ticks.forEach((tick, i) => {
        const { force, torque } = wrenches[i].wrench, pose = tools[i].pose;
        need(near(force.x, tick.fx) && near(force.z, tick.fz) && near(torque.y, tick.ty), "wrench of tick " + i);
        need(near(pose.position.z, tick.tool_z) && near(pose.orientation.w, tick.tool_qw), "pose of tick " + i);
        need(wrenches[i].header.frame_id === "base", "frame of tick " + i);
    });
    const images = heard["/camera/aligned_depth_to_color/image_raw"] ?? heard["/camera/depth/image_raw"];
    need(images.length > 0 && images[0].data.length === images[0].step * images[0].height, "depth image");
    const cloud = heard["/fathom/regions"][0];
    need(cloud.fields.map((field) => field.name).join() === "x,y,z,radius,class", "fields of the regions");
    need(cloud.data.length === cloud.width * cloud.point_step && cloud.width > 0, "size of the regions");
    console.log("npm: " + Object.entries(heard).map(([topic, all]) => all.length + " " + topic).join(", "));
}

main().catch((error) => need(false, error.stack));
