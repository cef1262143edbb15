#include "screwline/ros/param_reader.h"

#include "screwline/exception.h"
#include "screwline/ros/checks.h"

namespace screwline {
namespace ros_bridge {
namespace {

using XmlRpc::XmlRpcValue;

const char* typeName(const XmlRpcValue& value) {
  switch (value.getType()) {
    case XmlRpcValue::TypeBoolean:
      return "a boolean";
    case XmlRpcValue::TypeInt:
      return "an integer";
    case XmlRpcValue::TypeDouble:
      return "a number";
    case XmlRpcValue::TypeString:
      return "a string";
    case XmlRpcValue::TypeArray:
      return "a list";
    case XmlRpcValue::TypeStruct:
      return "a struct";
    default:
      return "of another type";
  }
}

}  // namespace

ParamReader::ParamReader(const XmlRpcValue& values, const std::string& prefix) : prefix_(prefix), values_(values) {
  if (values_.valid() && values_.getType() != XmlRpcValue::TypeStruct) {
    throw ModelError(prefix_ + " is " + typeName(values_) + ", it must be a struct");
  }
}

bool ParamReader::has(const std::string& key) const {
  return values_.valid() && values_.hasMember(key);
}

void ParamReader::pass(const std::string& key) {
  known_.insert(key);
}

std::string ParamReader::text(const std::string& key, const std::string& otherwise) {
  const XmlRpcValue* value = find(key);
  if (value == nullptr) return otherwise;
  if (value->getType() != XmlRpcValue::TypeString) refuse(key, std::string(typeName(*value)) + ", it must be a string");
  return std::string(XmlRpcValue(*value));
}

std::vector<std::string> ParamReader::texts(const std::string& key) {
  const XmlRpcValue* value = find(key);
  if (value == nullptr) return {};
  if (value->getType() != XmlRpcValue::TypeArray) {
    refuse(key, std::string(typeName(*value)) + ", it must be a list of strings");
  }
  XmlRpcValue array(*value);
  std::vector<std::string> result;
  for (int i = 0; i < array.size(); ++i) {
    if (array[i].getType() != XmlRpcValue::TypeString) {
      refuse(key + "[" + std::to_string(i) + "]", std::string(typeName(array[i])) + ", it must be a string");
    }
    result.push_back(std::string(array[i]));
  }
  return result;
}

bool ParamReader::flag(const std::string& key, bool otherwise) {
  const XmlRpcValue* value = find(key);
  if (value == nullptr) return otherwise;
  if (value->getType() != XmlRpcValue::TypeBoolean)
    refuse(key, std::string(typeName(*value)) + ", it must be a boolean");
  return bool(XmlRpcValue(*value));
}

std::optional<double> ParamReader::givenNumber(const std::string& key) {
  const XmlRpcValue* value = find(key);
  if (value == nullptr) return std::nullopt;
  const bool whole = value->getType() == XmlRpcValue::TypeInt;
  if (!whole && value->getType() != XmlRpcValue::TypeDouble) {
    refuse(key, std::string(typeName(*value)) + ", it must be a number");
  }
  XmlRpcValue copy(*value);
  return whole ? int(copy) : double(copy);
}

double ParamReader::number(const std::string& key, double otherwise, double above, double at_most) {
  const std::optional<double> number = givenNumber(key);
  if (!number) return otherwise;
  if (!(*number > above && *number <= at_most)) {
    refuse(key,
           numberText(*number) + ", it must be above " + numberText(above) + " and at most " + numberText(at_most));
  }
  return *number;
}

double ParamReader::numberFromZero(const std::string& key, double otherwise, double at_most) {
  const std::optional<double> number = givenNumber(key);
  if (!number) return otherwise;
  if (!(*number >= 0.0 && *number <= at_most)) {
    refuse(key, numberText(*number) + ", it must be from 0 to " + numberText(at_most));
  }
  return *number;
}

int ParamReader::integer(const std::string& key, int otherwise, int at_least, int at_most) {
  const XmlRpcValue* value = find(key);
  if (value == nullptr) return otherwise;
  if (value->getType() != XmlRpcValue::TypeInt) refuse(key, std::string(typeName(*value)) + ", it must be an integer");
  const int number = int(XmlRpcValue(*value));
  if (number < at_least || number > at_most) {
    refuse(key,
           std::to_string(number) + ", it must be from " + std::to_string(at_least) + " to " + std::to_string(at_most));
  }
  return number;
}

void ParamReader::refuseUnknown() const {
  if (!values_.valid()) return;
  std::string names;
  for (const std::string& name : known_) names += (names.empty() ? "" : ", ") + name;
  XmlRpcValue values(values_);
  for (const auto& entry : values) {
    if (known_.count(entry.first) == 0)
      throw ModelError(prefix_ + entry.first + " is no parameter; known are " + names);
  }
}

const XmlRpcValue* ParamReader::find(const std::string& key) {
  known_.insert(key);
  if (!has(key)) return nullptr;
  current_ = values_[key];
  return &current_;
}

void ParamReader::refuse(const std::string& key, const std::string& what) const {
  throw ModelError(prefix_ + key + " is " + what);
}

}  // namespace ros_bridge
}  // namespace screwline
