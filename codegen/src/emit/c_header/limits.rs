//! The faults of a desired motion beyond its limits, for a module whose step looks at them.

/// Words of the texts with what stands for them: nothing more where the step takes any motion.
pub(super) fn words(checked: bool) -> [(&'static str, &'static str); 4] {
    let [header, shim, fault, reason] = match checked {
        true => [HEADER, SHIM, FAULT, "Reason, "],
        false => ["", "", "fault.quantity.into()", ""],
    };
    [("header_limits", header), ("shim_limits", shim), ("shim_fault", fault), ("shim_reason", reason)]
}

const HEADER: &str = "
    /* The desired position is beyond the limits that the controller was generated for; `fault_joint` is the first joint. */
    {{NAME}}_FAULT_POSITION_LIMIT = 9,
    /* The desired velocity is beyond its limit. */
    {{NAME}}_FAULT_VELOCITY_LIMIT = 10,
    /* The desired acceleration is beyond its limit. */
    {{NAME}}_FAULT_ACCELERATION_LIMIT = 11,";

const SHIM: &str = "
    PositionLimit = 9,
    VelocityLimit = 10,
    AccelerationLimit = 11,";

const FAULT: &str = "match (fault.reason, fault.quantity) {
                        (Reason::BeyondLimits, Quantity::DesiredVelocity) => Fault::VelocityLimit,
                        (Reason::BeyondLimits, Quantity::DesiredAcceleration) => Fault::AccelerationLimit,
                        (Reason::BeyondLimits, _) => Fault::PositionLimit,
                        (Reason::NotFinite, quantity) => quantity.into(),
                    }";
