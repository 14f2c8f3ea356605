    // The bus: an APB3 master. What it sets at a falling edge of the clock stands still at the rising one.
    localparam integer ACCESS_CYCLES_MAX = {{ access_cycles_max }};
    reg psel, penable, pwrite;
    reg [12:0] paddr;
    reg [31:0] pwdata;
    wire [31:0] prdata;
    wire pready, pslverr;

    task host_idle;
        begin
            psel = 1'b0;
            penable = 1'b0;
            pwrite = 1'b0;
            paddr = 13'd0;
            pwdata = 32'd0;
        end
    endtask

    task transfer(input write, input [31:0] address, input [31:0] value);
        integer k;
        begin
            @(negedge clk);
            psel = 1'b1;
            pwrite = write;
            paddr = {address[10:0], 2'b00};
            pwdata = value;
            @(negedge clk);
            penable = 1'b1;
            for (k = 0; k < ACCESS_CYCLES_MAX && !pready; k = k + 1)
                @(negedge clk);
            check("pready", {47'd0, pready}, 48'd1);
            check("pslverr", {47'd0, pslverr}, 48'd0);
            answer = prdata;
            @(negedge clk);
            host_idle;
        end
    endtask
