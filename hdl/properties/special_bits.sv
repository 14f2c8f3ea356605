// special_is_found: If a special bit of a frame says alarm, power failure or not valid, the frame has that cause; without one it has not.
wire [2:0] f_bad = {
    |((status ^ NOT_VALID_LOW) & NOT_VALID_MASK), |((status ^ POWER_FAIL_LOW) & POWER_FAIL_MASK), |((status ^ ALARM_LOW) & ALARM_MASK)};
always @* begin
    special_is_found_alone: assert ((status & ~STORED_MASK) == 14'd0);
    special_is_found: assert (found[10:8] == (heard ? f_bad | bad_before : 3'd0));
end
// with HAS_GUARDS
// special_as_it_came: The stored special bits are the received ones: both have the same sum.
always @*
    special_as_it_came: assert ((^status) == sum);
// end
