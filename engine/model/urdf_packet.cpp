// SPDX-License-Identifier: Apache-2.0
#include "engine/model/urdf_packet.h"

#include <cstring>
#include <map>

namespace fathom {

namespace {

class PacketWriter {
public:
    explicit PacketWriter(std::string& bytes)
        : bytes_(bytes) {}
    template <class Number>
    void number(const Number& value) {
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    void text(const std::string& value) {
        number(uint64_t{value.size()});
        bytes_ += value;
    }

private:
    std::string& bytes_;
};

// Reads zeros and empty texts after the end.
class PacketReader {
public:
    explicit PacketReader(std::string_view bytes)
        : bytes_(bytes) {}
    template <class Number>
    void number(Number& value) {
        whole_ = whole_ && bytes_.size() >= sizeof value;
        value = Number{};
        if (whole_) {
            std::memcpy(&value, bytes_.data(), sizeof value);
            bytes_.remove_prefix(sizeof value);
        }
    }
    void text(std::string& value) {
        uint64_t size = 0;
        number(size);
        whole_ = whole_ && bytes_.size() >= size;
        value = whole_ ? bytes_.substr(0, size) : std::string_view();
        bytes_.remove_prefix(value.size());
    }
    bool whole() const { return whole_; }
    bool atEnd() const { return whole_ && bytes_.empty(); }

private:
    std::string_view bytes_;
    bool whole_ = true;
};

// The functions below read or write, by the kind of Packet.

template <class Packet, class Vector>
void vector(Packet& packet, Vector& v) {
    packet.number(v.x);
    packet.number(v.y);
    packet.number(v.z);
}

template <class Packet, class PoseOf>
void pose(Packet& packet, PoseOf& p) {
    vector(packet, p.position);
    vector(packet, p.rotation);
    packet.number(p.rotation.w);
}

template <class Packet>
void size(Packet& packet, urdf::Geometry& shape) {
    switch (shape.type) {
    case urdf::Geometry::SPHERE:
        return packet.number(static_cast<urdf::Sphere&>(shape).radius);
    case urdf::Geometry::BOX:
        return vector(packet, static_cast<urdf::Box&>(shape).dim);
    case urdf::Geometry::CYLINDER:
        packet.number(static_cast<urdf::Cylinder&>(shape).radius);
        return packet.number(static_cast<urdf::Cylinder&>(shape).length);
    case urdf::Geometry::MESH:
        packet.text(static_cast<urdf::Mesh&>(shape).filename);
        return vector(packet, static_cast<urdf::Mesh&>(shape).scale);
    }
}

template <class Packet>
void limits(Packet& packet, urdf::JointLimits& of) {
    packet.number(of.lower);
    packet.number(of.upper);
    packet.number(of.velocity);
}

template <class Packet>
void mimic(Packet& packet, urdf::JointMimic& of) {
    packet.text(of.joint_name);
    packet.number(of.multiplier);
    packet.number(of.offset);
}

template <class Packet>
void names(Packet& packet, urdf::Joint& joint) {
    packet.text(joint.name);
    packet.text(joint.parent_link_name);
    packet.text(joint.child_link_name);
    vector(packet, joint.axis);
    pose(packet, joint.parent_to_joint_origin_transform);
}

void write(PacketWriter& packet, const urdf::Link& link) {
    packet.text(link.name);
    packet.number(uint8_t{!link.visual_array.empty()});
    packet.number(uint8_t{link.inertial != nullptr});
    packet.number(uint64_t{link.collision_array.size()});
    for (const auto& collision : link.collision_array) {
        packet.number(static_cast<uint8_t>(collision->geometry->type));
        pose(packet, collision->origin);
        size(packet, *collision->geometry);
    }
}

void write(PacketWriter& packet, urdf::Joint& joint) {
    names(packet, joint);
    packet.number(static_cast<uint8_t>(joint.type));
    packet.number(uint8_t{joint.limits != nullptr});
    if (joint.limits) {
        limits(packet, *joint.limits);
    }
    packet.number(uint8_t{joint.mimic != nullptr});
    if (joint.mimic) {
        mimic(packet, *joint.mimic);
    }
}

std::shared_ptr<urdf::Geometry> shapeOf(uint8_t type) {
    switch (type) {
    case urdf::Geometry::SPHERE:
        return std::make_shared<urdf::Sphere>();
    case urdf::Geometry::BOX:
        return std::make_shared<urdf::Box>();
    case urdf::Geometry::CYLINDER:
        return std::make_shared<urdf::Cylinder>();
    case urdf::Geometry::MESH:
        return std::make_shared<urdf::Mesh>();
    default:
        return nullptr;
    }
}

bool readShapes(PacketReader& packet, urdf::Link& link) {
    uint64_t shapes = 0;
    packet.number(shapes);
    for (uint64_t i = 0; i < shapes && packet.whole(); ++i) {
        const auto collision = std::make_shared<urdf::Collision>();
        uint8_t type = 0;
        packet.number(type);
        pose(packet, collision->origin);
        collision->geometry = shapeOf(type);
        if (!collision->geometry) {
            return false;
        }
        size(packet, *collision->geometry);
        link.collision_array.push_back(collision);
    }
    return packet.whole();
}

bool readLink(PacketReader& packet, urdf::ModelInterface& model) {
    const auto link = std::make_shared<urdf::Link>();
    uint8_t visible = 0, heavy = 0;
    packet.text(link->name);
    packet.number(visible);
    packet.number(heavy);
    if (visible != 0) {
        link->visual_array.push_back(std::make_shared<urdf::Visual>());
    }
    link->inertial = heavy != 0 ? std::make_shared<urdf::Inertial>() : nullptr;
    model.links_[link->name] = link;
    return readShapes(packet, *link);
}

bool readJoint(PacketReader& packet, urdf::ModelInterface& model) {
    const auto joint = std::make_shared<urdf::Joint>();
    names(packet, *joint);
    uint8_t type = 0, limited = 0, follows = 0;
    packet.number(type);
    packet.number(limited);
    if (type > urdf::Joint::FIXED) {
        return false;
    }
    joint->type = static_cast<decltype(joint->type)>(type);
    if (limited != 0) {
        joint->limits = std::make_shared<urdf::JointLimits>();
        limits(packet, *joint->limits);
    }
    packet.number(follows);
    if (follows != 0) {
        joint->mimic = std::make_shared<urdf::JointMimic>();
        mimic(packet, *joint->mimic);
    }
    model.joints_[joint->name] = joint;
    return packet.whole();
}

// Links in a loop would own each other for ever.
bool isTree(const urdf::ModelInterface& model) {
    std::map<std::string, std::string> parents;
    for (const auto& [name, joint] : model.joints_) {
        if (!parents.emplace(joint->child_link_name, joint->parent_link_name).second) {
            return false;
        }
    }
    for (const auto& [name, ignored] : model.links_) {
        size_t steps = 0;
        for (auto at = parents.find(name); at != parents.end(); at = parents.find(at->second)) {
            if (++steps > model.links_.size()) {
                return false;
            }
        }
    }
    return true;
}

bool readAll(PacketReader& packet, UrdfModel& model) {
    uint64_t notes = 0, links = 0, joints = 0;
    packet.number(notes);
    for (uint64_t i = 0; i < notes && packet.whole(); ++i) {
        packet.text(model.notes.emplace_back());
    }
    packet.number(links);
    packet.number(joints);
    bool sound = links <= kMaxLinks && joints <= kMaxLinks;
    for (uint64_t i = 0; i < links && sound; ++i) {
        sound = readLink(packet, model);
    }
    for (uint64_t i = 0; i < joints && sound; ++i) {
        sound = readJoint(packet, model);
    }
    return sound && packet.atEnd() && isTree(model);
}

} // namespace

std::string packUrdf(const urdf::ModelInterface& model, const std::vector<std::string>& notes) {
    std::string bytes;
    PacketWriter packet(bytes);
    packet.number(uint64_t{notes.size()});
    for (const std::string& note : notes) {
        packet.text(note);
    }
    packet.number(uint64_t{model.links_.size()});
    packet.number(uint64_t{model.joints_.size()});
    for (const auto& [name, link] : model.links_) {
        write(packet, *link);
    }
    for (const auto& [name, joint] : model.joints_) {
        write(packet, *joint);
    }
    return bytes;
}

std::shared_ptr<const UrdfModel> unpackUrdf(std::string_view packet) {
    auto model = std::make_shared<UrdfModel>();
    PacketReader reader(packet);
    if (!readAll(reader, *model)) {
        return nullptr;
    }
    try {
        std::map<std::string, std::string> parents;
        model->initTree(parents);
        model->initRoot(parents);
    } catch (const urdf::ParseError&) {
        return nullptr;
    }
    return model;
}

} // namespace fathom
